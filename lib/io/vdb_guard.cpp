// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <fstream>

#include "core/error.hpp"
#include "io/foreign_guard.hpp"

namespace gdesp {
namespace {

constexpr std::int64_t magic = 0x56444220;     // " BDV"
constexpr std::uint32_t oldest_version = 222;  // the first with this layout; OpenVDB 3 and later
constexpr std::size_t uuid_size = 36;

class VdbHeader {
 public:
  explicit VdbHeader(const std::string& path) : path_(path), in_(path, std::ios::binary | std::ios::ate) {
    if (!in_) throw Error(ErrorKind::input, path + ": there is no such file, or it cannot be read");
    size_ = static_cast<std::int64_t>(in_.tellg());
    in_.seekg(0);
  }

  void check() {
    if (number<std::int64_t>() != magic) refuse("it does not start as an OpenVDB file");
    if (number<std::uint32_t>() < oldest_version) refuse("its version is older than OpenVDB 3");
    number<std::uint32_t>();  // library, major
    number<std::uint32_t>();  // library, minor
    const bool has_offsets = number<std::uint8_t>() != 0;
    skip(uuid_size);
    skip_metadata();
    const auto grids = number<std::int32_t>();
    if (!has_offsets || grids < 0) refuse("it has no table of grids");
    for (std::int32_t i = 0; i < grids; ++i) {
      for (int text = 0; text < 3; ++text) skip(number<std::uint32_t>());  // name, type, parent
      number<std::int64_t>();                                              // start of the grid
      number<std::int64_t>();                                              // start of its blocks
      const auto end = number<std::int64_t>();
      if (end < in_.tellg() || end > size_)
        refuse("grid " + std::to_string(i) + " ends at byte " + std::to_string(end) + " of " + std::to_string(size_));
      in_.seekg(end);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorKind::input, path_ + ": damaged or incomplete OpenVDB file: " + why);
  }
  template <class T>
  T number() {
    T value{};
    if (!in_.read(reinterpret_cast<char*>(&value), sizeof value)) refuse("its header is cut short");
    return value;
  }
  void skip(std::uint64_t bytes) {
    if (bytes > std::uint64_t(size_ - in_.tellg())) refuse("its header is cut short");
    in_.seekg(std::streamoff(bytes), std::ios::cur);
  }
  void skip_metadata() {
    const auto count = number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i)
      for (int part = 0; part < 3; ++part) skip(number<std::uint32_t>());  // name, type, value
  }

  std::string path_;
  std::ifstream in_;
  std::int64_t size_ = 0;
};

}  // namespace

void refuse_torn_vdb(const std::string& path) { VdbHeader(path).check(); }

}  // namespace gdesp
