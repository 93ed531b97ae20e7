// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtp_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <type_traits>

#include "core/error.hpp"
#include "io/base64.hpp"

namespace gdesp {

struct VtpTag {
  std::string_view name;  // "/Piece" when it closes
  std::map<std::string_view, std::string_view> attributes;
  bool self_closing = false;
  std::string_view attribute(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view{} : found->second;
  }
};

namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

bool is_section(std::string_view name) {
  for (const char* one : {"FieldData", "PointData", "CellData", "Points", "Verts", "Lines", "Strips", "Polys"})
    if (name == one) return true;
  return false;
}

/// What VTK writes about an array inside it, after the data.
bool is_remark(std::string_view name) {
  return name == "InformationKey" || name == "/InformationKey" || name == "Value" || name == "/Value";
}

ScalarType type_of(std::string_view name) {
  for (const ScalarType type : {ScalarType::float32, ScalarType::float64, ScalarType::int32, ScalarType::uint32,
                                ScalarType::int64, ScalarType::uint8})
    if (name == vtk_name(type)) return type;
  throw OtherVtpFlavour{};
}

/// The byte count at the head of an array's text, and the first bytes of data that share its last four characters.
struct Head {
  unsigned char bytes[9] = {};
  std::uint64_t count = 0;
  bool sound = false;

  Head(std::string_view content, std::size_t header_size) {
    const std::size_t text = base64_size(header_size);
    if (content.size() < text) return;
    char copy[12];
    std::memcpy(copy, content.data(), text);
    for (std::size_t i = text - 2; i < text; ++i)
      if (copy[i] == '=') copy[i] = 'A';
    sound = base64_decode(copy, text / 4 * 3, bytes);
    std::memcpy(&count, bytes, header_size);
  }
};

template <class From, class To>
void convert(const unsigned char* bytes, std::size_t count, To* out) {
  for (std::size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, bytes + i * sizeof(From), sizeof(From));
    if constexpr (std::is_floating_point_v<From> && std::is_integral_v<To>) {
      constexpr double limit = sizeof(To) == 8 ? 9e18 : 2147483647.0;
      out[i] = double(value) >= -limit && double(value) <= limit ? static_cast<To>(value) : To(-1);
    } else {
      out[i] = static_cast<To>(value);
    }
  }
}

template <class T>
constexpr ScalarType scalar_type = std::is_same_v<T, float>
                                       ? ScalarType::float32
                                       : (std::is_same_v<T, double>
                                              ? ScalarType::float64
                                              : (sizeof(T) == 8 ? ScalarType::int64 : ScalarType::int32));

}  // namespace

VtpText::VtpText(const std::string& path) : path_(path) {
  load();
  rest_ = {bytes_.get(), size_};
  parse();
}

void VtpText::load() {
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw Error(ErrorKind::input,
                path_ + (errno == ENOENT ? ": there is no such file" : std::string(": ") + std::strerror(errno)));
  struct stat status {};
  const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const auto whole = static_cast<std::size_t>(regular ? status.st_size : 0);
  if (regular) bytes_ = std::make_unique_for_overwrite<char[]>(whole + 1);
  while (size_ < whole) {
    const ssize_t n = ::read(descriptor, bytes_.get() + size_, whole - size_);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    size_ += static_cast<std::size_t>(n);
  }
  ::close(descriptor);
  if (!regular) throw Error(ErrorKind::input, path_ + ": is not a file");
}

const VtpArrayText* VtpText::find(const std::string& section, const std::string& name) const {
  for (const VtpArrayText& a : arrays)
    if (a.section == section && a.name == name) return &a;
  return nullptr;
}

void VtpText::damaged(const std::string& what) const {
  throw Error(ErrorKind::input, path_ + ": damaged or incomplete VTP file: " + what);
}

std::size_t VtpText::byte_count(const VtpArrayText& a) const {
  if (a.content.empty()) return 0;
  const Head head(a.content, header_size_);
  if (!head.sound) damaged("array " + a.name + " has no byte count");
  const bool fits =
      head.count <= a.content.size() && (a.content.size() == base64_size(header_size_ + head.count) ||
                                         a.content.size() == base64_size(header_size_) + base64_size(head.count));
  if (!fits || head.count % size_of(a.type) != 0)
    damaged("array " + a.name + " says " + std::to_string(head.count) + " bytes and holds about " +
            std::to_string(a.content.size() / 4 * 3));
  return head.count;
}

/// Decodes exactly `bytes` (= byte_count) bytes of data.
void VtpText::decode(const VtpArrayText& a, std::size_t bytes, unsigned char* out) const {
  if (bytes == 0) return;
  const std::size_t head_text = base64_size(header_size_), head_bytes = head_text / 4 * 3;
  const bool joined = a.content.size() == base64_size(header_size_ + bytes);
  const std::size_t shared = joined ? std::min(bytes, head_bytes - header_size_) : 0;
  const Head head(a.content, header_size_);
  std::memcpy(out, head.bytes + header_size_, shared);
  if (!base64_decode(a.content.data() + head_text, bytes - shared, out + shared))
    damaged("array " + a.name + " is not base64");
}

std::size_t VtpText::count(const VtpArrayText& a) const { return byte_count(a) / size_of(a.type); }

template <class T>
void VtpText::read(const VtpArrayText& a, std::size_t expected, T* values) const {
  const std::size_t bytes = byte_count(a), found = bytes / size_of(a.type);
  if (found != expected)
    damaged("array " + a.name + " holds " + std::to_string(found) + " values, expected " + std::to_string(expected));
  if (a.type == scalar_type<T>) return decode(a, bytes, reinterpret_cast<unsigned char*>(values));
  std::vector<unsigned char> raw(bytes);
  decode(a, bytes, raw.data());
  switch (a.type) {
    case ScalarType::float32:
      return convert<float>(raw.data(), found, values);
    case ScalarType::float64:
      return convert<double>(raw.data(), found, values);
    case ScalarType::int32:
      return convert<std::int32_t>(raw.data(), found, values);
    case ScalarType::uint32:
      return convert<std::uint32_t>(raw.data(), found, values);
    case ScalarType::int64:
      return convert<std::int64_t>(raw.data(), found, values);
    case ScalarType::uint8:
      return convert<std::uint8_t>(raw.data(), found, values);
  }
}

template void VtpText::read(const VtpArrayText&, std::size_t, float*) const;
template void VtpText::read(const VtpArrayText&, std::size_t, double*) const;
template void VtpText::read(const VtpArrayText&, std::size_t, std::int32_t*) const;
template void VtpText::read(const VtpArrayText&, std::size_t, std::int64_t*) const;

std::size_t VtpText::number(const VtpTag& tag, std::string_view key) const {
  const std::string_view text = tag.attribute(key);
  if (text.empty()) return 0;
  std::size_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || value > size_)
    damaged(std::string(key) + " = \"" + std::string(text.substr(0, 30)) + "\" in a file of " + std::to_string(size_) +
            " bytes");
  return value;
}

/// Moves past the next tag; false at the end of the text. `before`: what stood in front of it.
bool VtpText::next_tag(VtpTag& tag, std::string_view& before) {
  const std::size_t open = rest_.find('<');
  if (open == std::string_view::npos) return false;
  before = rest_.substr(0, open);
  const std::size_t close = rest_.find('>', open);
  if (close == std::string_view::npos) damaged("a tag has no end");
  std::string_view inside = rest_.substr(open + 1, close - open - 1);
  rest_ = rest_.substr(close + 1);
  tag = {};
  if (!inside.empty() && inside.front() == '?') inside = {};
  if (!inside.empty() && inside.front() == '!') throw OtherVtpFlavour{};
  if (!inside.empty() && inside.back() == '/') {
    tag.self_closing = true;
    inside.remove_suffix(1);
  }
  std::size_t end = 0;
  while (end < inside.size() && !is_space(inside[end])) ++end;
  tag.name = inside.substr(0, end);
  parse_attributes(inside.substr(end), tag);
  return true;
}

void VtpText::parse_attributes(std::string_view text, VtpTag& tag) const {
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals + 1 >= text.size()) damaged("an attribute has no value");
    const char quote = text[equals + 1];
    const std::size_t end = text.find(quote, equals + 2);
    if ((quote != '"' && quote != '\'') || end == std::string_view::npos) damaged("an attribute has no end");
    tag.attributes[trimmed(text.substr(0, equals))] = text.substr(equals + 2, end - equals - 2);
    text = text.substr(end + 1);
  }
}

void VtpText::start_file(const VtpTag& tag) {
  if (tag.attribute("type") != "PolyData" || tag.attribute("byte_order") != "LittleEndian" ||
      !tag.attribute("compressor").empty())
    throw OtherVtpFlavour{};
  header_size_ = tag.attribute("header_type") == "UInt64" ? 8 : 4;
}

void VtpText::start_piece(const VtpTag& tag, bool& seen) {
  if (seen || number(tag, "NumberOfLines") || number(tag, "NumberOfStrips")) throw OtherVtpFlavour{};
  seen = true;
  points = number(tag, "NumberOfPoints");
  triangles = number(tag, "NumberOfPolys");
}

void VtpText::start_array(const VtpTag& tag, const std::string& section) {
  if (tag.attribute("format") != "binary" || tag.name != "DataArray") throw OtherVtpFlavour{};
  VtpArrayText a{section, std::string(tag.attribute("Name")), type_of(tag.attribute("type")), 1, {}};
  if (!tag.attribute("NumberOfComponents").empty())
    a.components = static_cast<int>(std::min<std::size_t>(number(tag, "NumberOfComponents"), 1000));
  if (a.components < 1) damaged("array " + a.name + " has no components");
  arrays.push_back(a);
}

void VtpText::parse() {
  VtpTag tag;
  std::string_view before;
  std::string section;
  bool in_array = false, file_seen = false, piece_seen = false, complete = false;
  while (next_tag(tag, before)) {
    if (in_array && arrays.back().content.empty()) arrays.back().content = trimmed(before);
    if (in_array && is_remark(tag.name)) continue;
    if (in_array && tag.name != "/DataArray") damaged("an array has no end");
    if (tag.name == "VTKFile") {
      file_seen = true;
      start_file(tag);
    } else if (!file_seen && !tag.name.empty()) {
      damaged("it does not start with <VTKFile>");
    } else if (tag.name == "Piece") {
      start_piece(tag, piece_seen);
    } else if (tag.name == "DataArray" || tag.name == "Array") {
      start_array(tag, section);
      in_array = !tag.self_closing;
    } else if (tag.name == "/DataArray") {
      in_array = false;
    } else if (tag.name == "/VTKFile") {
      complete = true;
    } else if (tag.name == "AppendedData") {
      throw OtherVtpFlavour{};
    } else if (is_section(tag.name)) {
      section = std::string(tag.name);
    }
  }
  if (!file_seen) damaged("it holds no <VTKFile>");
  if (!complete || in_array) damaged("its end is missing");
  if (!piece_seen) damaged("it holds no <Piece>");
}

}  // namespace gdesp
