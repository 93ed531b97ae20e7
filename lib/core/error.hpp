// SPDX-License-Identifier: GPL-3.0-or-later
// What went wrong, of which kind, said to the person who can mend it. The library throws Error; only the
// tools print, and map the kind to an exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace gdesp {

/// The kinds of failure, with the exit code that a tool ends with.
enum class ErrorKind {
  usage = 2,      ///< the command line is off
  input = 3,      ///< a file, a key or a value that cannot be used
  numerical = 4,  ///< the simulation left the range in which its method is valid
  resource = 5,   ///< memory, disk, device
};

/// A message complete in itself: file, key or line, the value found, its unit, what would be valid.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }
  int exit_code() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

}  // namespace gdesp
