// SPDX-License-Identifier: GPL-3.0-or-later
// Output that appears under its name only when it is complete: written aside, then renamed. A write that fails
// (no room, no permission, no folder) is an Error(resource) that says which file and why, and leaves nothing behind.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gdesp {

class SafeFile {
 public:
  explicit SafeFile(std::string path);  ///< opens `path`.part-PID
  ~SafeFile();                          ///< removes it unless committed
  SafeFile(const SafeFile&) = delete;
  SafeFile& operator=(const SafeFile&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();  ///< closes and renames

 private:
  [[noreturn]] void fail(const char* doing);
  std::string path_, aside_;
  int descriptor_ = -1;
};

/// Writes a small file in one go.
void write_text_file(const std::string& path, std::string_view text);
/// A whole file; Error(input) when it is missing, a folder, unreadable, or larger than `largest` bytes.
std::string read_text_file(const std::string& path, std::size_t largest);

}  // namespace gdesp
