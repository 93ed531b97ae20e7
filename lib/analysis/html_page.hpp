// SPDX-License-Identifier: GPL-3.0-or-later
// A page of HTML complete in itself: pictures inside as data, no network, readable on a desk and on a telephone.
#pragma once

#include <string>
#include <vector>

#include "analysis/plot.hpp"
#include "analysis/table.hpp"

namespace gdesp::analysis {

class HtmlPage {
 public:
  HtmlPage(const std::string& title, const std::string& subtitle);
  void heading(const std::string& text);
  void paragraph(const std::string& text);           ///< text, escaped
  void list(const std::vector<std::string>& items);  ///< escaped
  void warning(const std::string& text);
  /// A table that scrolls sideways where the screen is narrow. Numbers are set flush right.
  void table(const Table& table);
  void figure(const Figure& figure, const std::string& caption);  ///< drawn as SVG
  void png(const std::string& path, const std::string& caption);  ///< an existing picture, put inside
  /// Text as it is, folded away behind its title.
  void folded(const std::string& title, const std::string& text);
  /// The whole page, with a table of contents made of the headings.
  std::string text() const;

 private:
  std::string title_, subtitle_, body_;
  std::vector<std::string> headings_;
};

std::string escape_html(const std::string& text);

}  // namespace gdesp::analysis
