// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/html_page.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "io/base64.hpp"

namespace gdesp::analysis {
namespace {

const char* const style = R"(
:root{color-scheme:light}
*{box-sizing:border-box}
body{margin:0 auto;padding:1.2rem;max-width:62rem;font:16px/1.5 system-ui,-apple-system,"Segoe UI",Helvetica,Arial,sans-serif;color:#1c2733;background:#fff}
header{border-bottom:3px solid #0072b2;margin-bottom:1rem}
h1{font-size:1.7rem;line-height:1.2;margin:.2rem 0}
h2{font-size:1.25rem;margin:2.2rem 0 .6rem;padding-bottom:.2rem;border-bottom:1px solid #ccd5dd}
header p{margin:.2rem 0 .8rem;color:#51606e}
nav{font-size:.92rem}nav a{margin-right:1rem;white-space:nowrap}
a{color:#0060a0}
.wide{overflow-x:auto;margin:.8rem 0;-webkit-overflow-scrolling:touch}
table{border-collapse:collapse;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .7rem;border-bottom:1px solid #dde3e9;text-align:left;vertical-align:top}
th{border-bottom:2px solid #9fb0bf;white-space:nowrap}
td.n{text-align:right;white-space:nowrap}
figure{margin:1.2rem 0}
.pan{overflow-x:auto}
figure img{display:block;width:100%;max-width:56rem;height:auto}
figcaption{color:#51606e;font-size:.92rem;margin-top:.3rem}
.warning{border-left:5px solid #d55e00;background:#fdf3ec;padding:.6rem .9rem;margin:.8rem 0}
details{margin:.8rem 0}summary{cursor:pointer;color:#0060a0}
pre{overflow-x:auto;background:#f4f6f8;padding:.8rem;font-size:.85rem;line-height:1.4}
@media(max-width:40rem){body{padding:.8rem;font-size:15px}h1{font-size:1.35rem}figure img{min-width:34rem}
th:first-child,td:first-child{position:sticky;left:0;background:#fff}th,td{padding:.3rem .5rem}}
@media print{nav{display:none}body{max-width:none}figure,table{break-inside:avoid}}
)";

std::string data_uri(const std::string& kind, const std::string& bytes) {
  std::string text(base64_size(bytes.size()), '=');
  base64_encode(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), text.data());
  return "data:" + kind + ";base64," + text;
}

std::string image(const std::string& uri, const std::string& caption) {
  return "<figure><div class=\"pan\"><img alt=\"" + escape_html(caption) + "\" src=\"" + uri + "\"></div><figcaption>" +
         escape_html(caption) + "</figcaption></figure>\n";
}

}  // namespace

namespace {

// 1.23e+10 as 1.23 × 10¹⁰.
std::string readable_number(double value) {
  if (!std::isfinite(value)) return "–";
  const std::string text = format_number(value);
  const auto e = text.find('e');
  return e == std::string::npos
             ? text
             : text.substr(0, e) + " × 10<sup>" + std::to_string(std::stoi(text.substr(e + 1))) + "</sup>";
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

HtmlPage::HtmlPage(const std::string& title, const std::string& subtitle) : title_(title), subtitle_(subtitle) {}

void HtmlPage::heading(const std::string& text) {
  headings_.push_back(text);
  body_ += "<h2 id=\"s" + std::to_string(headings_.size()) + "\">" + escape_html(text) + "</h2>\n";
}

void HtmlPage::paragraph(const std::string& text) { body_ += "<p>" + escape_html(text) + "</p>\n"; }

void HtmlPage::warning(const std::string& text) { body_ += "<p class=\"warning\">" + escape_html(text) + "</p>\n"; }

void HtmlPage::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + escape_html(item) + "</li>\n";
  body_ += "</ul>\n";
}

void HtmlPage::table(const Table& table) {
  body_ += "<div class=\"wide\"><table><thead><tr>";
  for (const std::string& name : table.column) body_ += "<th>" + escape_html(name) + "</th>";
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.row) {
    body_ += "<tr>";
    for (const Cell& cell : row) {
      const double* number = std::get_if<double>(&cell);
      body_ += number ? "<td class=\"n\">" + readable_number(*number) + "</td>"
                      : "<td>" + escape_html(std::get<std::string>(cell)) + "</td>";
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::figure(const Figure& figure, const std::string& caption) {
  body_ += image(data_uri("image/svg+xml", figure_as_svg(figure)), caption);
}

void HtmlPage::png(const std::string& path, const std::string& caption) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(ErrorKind::input, path + ": cannot be opened; a PNG picture is needed");
  std::ostringstream bytes;
  bytes << in.rdbuf();
  body_ += image(data_uri("image/png", bytes.str()), caption);
}

void HtmlPage::folded(const std::string& title, const std::string& text) {
  body_ += "<details><summary>" + escape_html(title) + "</summary><pre>" + escape_html(text) + "</pre></details>\n";
}

std::string HtmlPage::text() const {
  std::string contents;
  for (std::size_t k = 0; k < headings_.size(); ++k) {
    contents += "<a href=\"#s" + std::to_string(k + 1) + "\">" + escape_html(headings_[k]) + "</a> ";
  }
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escape_html(title_) + "</title>\n<style>" + style + "</style></head>\n<body>\n<header><h1>" +
         escape_html(title_) + "</h1><p>" + escape_html(subtitle_) + "</p></header>\n<nav>" + contents + "</nav>\n" +
         body_ + "</body></html>\n";
}

}  // namespace gdesp::analysis
