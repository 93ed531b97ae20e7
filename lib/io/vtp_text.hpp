// SPDX-License-Identifier: GPL-3.0-or-later
// The text of an inline binary VTP file, taken apart: which arrays there are and where their base64 lies. Every size is
// checked against the text that is there before memory is taken.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/vtp_writer.hpp"

namespace gdesp {

/// Raised inside the module when a file is VTP of another flavour (compressed, appended, ascii, several pieces ...).
struct OtherVtpFlavour {};

struct VtpArrayText {
  std::string section, name;  ///< section: FieldData PointData CellData Points Verts Polys ...
  ScalarType type;
  int components = 1;
  std::string_view content;  ///< base64 of a byte count and of the data, in one stream or in two
};

struct VtpTag;

class VtpText {
 public:
  /// Throws Error(input) when the file is missing or damaged, OtherVtpFlavour when it is not for this reader.
  explicit VtpText(const std::string& path);

  std::size_t points = 0, triangles = 0;
  std::vector<VtpArrayText> arrays;

  /// Null when there is none.
  const VtpArrayText* find(const std::string& section, const std::string& name) const;
  [[noreturn]] void damaged(const std::string& what) const;
  /// Number of values of the array; throws when its byte count and its text do not agree.
  std::size_t count(const VtpArrayText& a) const;
  /// Values converted to T, of which there must be exactly `expected`. T: float double int32_t int64_t.
  template <class T>
  void read(const VtpArrayText& a, std::size_t expected, T* values) const;
  template <class T>
  std::vector<T> read(const VtpArrayText& a) const {
    std::vector<T> values(count(a));
    read(a, values.size(), values.data());
    return values;
  }

 private:
  void load();
  void parse();
  bool next_tag(VtpTag& tag, std::string_view& before);
  void parse_attributes(std::string_view text, VtpTag& tag) const;
  std::size_t number(const VtpTag& tag, std::string_view key) const;
  void start_file(const VtpTag& tag);
  void start_piece(const VtpTag& tag, bool& seen);
  void start_array(const VtpTag& tag, const std::string& section);
  std::size_t byte_count(const VtpArrayText& a) const;
  void decode(const VtpArrayText& a, std::size_t bytes, unsigned char* out) const;

  std::string path_;
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
  std::string_view rest_;
  std::size_t header_size_ = 8;  // of the byte count
};

}  // namespace gdesp
