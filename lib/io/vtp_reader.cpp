// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of inline binary VTP without compression. Every size is checked against the text that is there before
// memory is taken.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <string_view>

#include "core/error.hpp"
#include "io/base64.hpp"
#include "io/point_source.hpp"
#include "io/vtp_writer.hpp"

namespace gdesp {
namespace {

/// Raised inside when the file is sound but of another flavour.
struct OtherFlavour {};

class FileText {
 public:
  explicit FileText(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
      throw Error(ErrorKind::input, path + (errno == ENOENT ? std::string(": there is no such file")
                                                            : ": cannot be opened: " + std::string(std::strerror(errno))));
    struct stat status {};
    const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
    if (regular) {
      bytes_ = std::make_unique_for_overwrite<char[]>(static_cast<std::size_t>(status.st_size) + 1);
      while (size_ < static_cast<std::size_t>(status.st_size)) {
        const ssize_t n = ::read(descriptor, bytes_.get() + size_, static_cast<std::size_t>(status.st_size) - size_);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        size_ += static_cast<std::size_t>(n);
      }
    }
    ::close(descriptor);
    if (!regular) throw Error(ErrorKind::input, path + ": is not a file");
  }
  std::string_view view() const { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
};

struct Tag {
  std::string_view name;  // "/Piece" when it closes
  std::map<std::string_view, std::string_view> attributes;
  bool self_closing = false;
  std::string_view attribute(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view{} : found->second;
  }
};

struct ArrayText {
  std::string section, name;
  ScalarType type;
  int components = 1;
  std::string_view content;
};

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

class VtpText {
 public:
  explicit VtpText(const std::string& path) : path_(path), file_(path), rest_(file_.view()) { parse(); }

  std::size_t points = 0, triangles = 0;
  std::vector<ArrayText> arrays;

  const ArrayText* find(const std::string& section, const std::string& name) const {
    for (const ArrayText& a : arrays) if (a.section == section && a.name == name) return &a;
    return nullptr;
  }

  [[noreturn]] void damaged(const std::string& what) const {
    throw Error(ErrorKind::input, path_ + ": damaged or incomplete VTP file: " + what);
  }

  /// Bytes of the array; their number comes from the array's own header and must be what its text holds.
  std::vector<unsigned char> bytes_of(const ArrayText& a) const {
    const std::size_t header_text = base64_size(header_size_);
    unsigned char header[8] = {};
    if (a.content.empty()) return {};
    if (a.content.size() < header_text) damaged("array " + a.name + " has no size");
    if (!base64_decode(a.content.data(), header_size_, header)) damaged("array " + a.name + " is not base64");
    std::uint64_t count = 0;
    std::memcpy(&count, header, 8);
    const std::string_view data = a.content.substr(header_text);
    if (count > data.size() || data.size() != base64_size(count))
      damaged("array " + a.name + " says " + std::to_string(count) + " bytes and holds " +
              std::to_string(data.size() / 4 * 3));
    std::vector<unsigned char> bytes(count);
    if (!base64_decode(data.data(), count, bytes.data())) damaged("array " + a.name + " is not base64");
    return bytes;
  }

  template <class T>
  std::vector<T> values(const ArrayText& a) const {
    const std::vector<unsigned char> bytes = bytes_of(a);
    const std::size_t count = bytes.size() / size_of(a.type);
    std::vector<T> out(count);
    switch (a.type) {
      case ScalarType::float32: convert<float>(bytes, out); break;
      case ScalarType::float64: convert<double>(bytes, out); break;
      case ScalarType::int32: convert<std::int32_t>(bytes, out); break;
      case ScalarType::uint32: convert<std::uint32_t>(bytes, out); break;
      case ScalarType::int64: convert<std::int64_t>(bytes, out); break;
      case ScalarType::uint8: convert<std::uint8_t>(bytes, out); break;
    }
    return out;
  }

  template <class T>
  std::vector<T> values(const ArrayText& a, std::size_t tuples) const {
    std::vector<T> out = values<T>(a);
    if (out.size() != tuples * static_cast<std::size_t>(a.components))
      damaged("array " + a.name + " holds " + std::to_string(out.size()) + " values, expected " +
              std::to_string(tuples) + " x " + std::to_string(a.components));
    return out;
  }

 private:
  template <class From, class To>
  static void convert(const std::vector<unsigned char>& bytes, std::vector<To>& out) {
    if constexpr (std::is_same_v<From, To>) {
      if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(To));
      return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      From value;
      std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
      if constexpr (std::is_floating_point_v<From> && std::is_integral_v<To>)
        out[i] = value >= From(-9e18) && value <= From(9e18) ? static_cast<To>(value) : To(-1);
      else
        out[i] = static_cast<To>(value);
    }
  }

  std::size_t number(const Tag& tag, std::string_view key) const {
    const std::string_view text = tag.attribute(key);
    if (text.empty()) return 0;
    std::size_t value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || value > file_.view().size())
      damaged(std::string(key) + " = \"" + std::string(text.substr(0, 30)) + "\" in a file of " +
              std::to_string(file_.view().size()) + " bytes");
    return value;
  }

  /// Moves past the next tag; false at the end of the text. `before`: what stood in front of it.
  bool next_tag(Tag& tag, std::string_view& before) {
    const std::size_t open = rest_.find('<');
    if (open == std::string_view::npos) return false;
    before = rest_.substr(0, open);
    const std::size_t close = rest_.find('>', open);
    if (close == std::string_view::npos) damaged("a tag has no end");
    std::string_view inside = rest_.substr(open + 1, close - open - 1);
    rest_ = rest_.substr(close + 1);
    tag = {};
    if (!inside.empty() && inside.front() == '?') inside = {};
    if (!inside.empty() && inside.front() == '!') throw OtherFlavour{};
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

  void parse_attributes(std::string_view text, Tag& tag) const {
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

  static ScalarType type_of(std::string_view name) {
    for (const ScalarType type : {ScalarType::float32, ScalarType::float64, ScalarType::int32, ScalarType::uint32,
                                  ScalarType::int64, ScalarType::uint8})
      if (name == vtk_name(type)) return type;
    throw OtherFlavour{};
  }

  void start_array(const Tag& tag, const std::string& section) {
    if (tag.attribute("format") != "binary" || tag.name != "DataArray") throw OtherFlavour{};
    ArrayText a{section, std::string(tag.attribute("Name")), type_of(tag.attribute("type")), 1, {}};
    if (!tag.attribute("NumberOfComponents").empty())
      a.components = static_cast<int>(std::min<std::size_t>(number(tag, "NumberOfComponents"), 1000));
    if (a.components < 1) damaged("array " + a.name + " has no components");
    arrays.push_back(a);
  }

  void start_file(const Tag& tag) {
    const std::string_view header = tag.attribute("header_type");
    if (tag.attribute("type") != "PolyData" || tag.attribute("byte_order") != "LittleEndian" ||
        !tag.attribute("compressor").empty())
      throw OtherFlavour{};
    header_size_ = header == "UInt64" ? 8 : 4;
  }

  void start_piece(const Tag& tag, bool& seen) {
    if (seen || number(tag, "NumberOfLines") || number(tag, "NumberOfStrips")) throw OtherFlavour{};
    seen = true;
    points = number(tag, "NumberOfPoints");
    triangles = number(tag, "NumberOfPolys");
  }

  void parse() {
    Tag tag;
    std::string_view before;
    std::string section;
    bool in_array = false, file_seen = false, piece_seen = false, complete = false;
    while (next_tag(tag, before)) {
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
      } else if (tag.name == "/DataArray" && in_array) {
        arrays.back().content = trimmed(before);
        in_array = false;
      } else if (tag.name == "/VTKFile") {
        complete = true;
      } else if (tag.name == "AppendedData") {
        throw OtherFlavour{};
      } else if (!tag.name.empty() && tag.name.front() != '/') {
        section = std::string(tag.name);
      }
    }
    if (!file_seen) damaged("it holds no <VTKFile>");
    if (!complete || in_array) damaged("its end is missing");
    if (!piece_seen) damaged("it holds no <Piece>");
    // Size and data in one base64 stream: other writers do so.
    const std::size_t last = base64_size(header_size_) - 1;
    for (const ArrayText& a : arrays) if (a.content.size() > last && a.content[last] != '=') throw OtherFlavour{};
  }

  std::string path_;
  FileText file_;
  std::string_view rest_;
  std::size_t header_size_ = 8;
};

class PlainVtp : public PointSource {
 public:
  explicit PlainVtp(const std::string& path) : text_(path) {
    const ArrayText* points = points_array();
    if (!points && text_.points > 0) text_.damaged("it holds no Points array");
    // Read now: another flavour shows in the first array, before anyone relies on this reader.
    if (points) {
      if (points->components != 3) text_.damaged("Points have not three components");
      const std::vector<double> xyz = text_.values<double>(*points, text_.points);
      positions_.resize(text_.points);
      for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
    }
  }

  std::size_t size() const override { return text_.points; }
  std::vector<Vec3d> positions() const override { return positions_; }
  std::vector<std::string> names() const override {
    std::vector<std::string> out;
    for (const ArrayText& a : text_.arrays) if (a.section == "PointData") out.push_back(a.name);
    return out;
  }
  int components(const std::string& name) const override {
    const ArrayText* a = text_.find("PointData", name);
    return a ? a->components : 0;
  }
  void read(const std::string& name, float* values) const override { copy(name, values); }
  void read(const std::string& name, std::int64_t* values) const override { copy(name, values); }
  std::vector<double> field(const std::string& name) const override {
    const ArrayText* a = text_.find("FieldData", name);
    return a ? text_.values<double>(*a) : std::vector<double>{};
  }

  TriangleTable triangles() const override {
    TriangleTable table;
    table.vertex = positions_;
    const ArrayText *corners = text_.find("Polys", "connectivity"), *ends = text_.find("Polys", "offsets");
    if (text_.triangles == 0) return table;
    if (!corners || !ends) text_.damaged("it holds no polygons though it says so");
    const std::vector<std::int64_t> corner = text_.values<std::int64_t>(*corners);
    const std::vector<std::int64_t> end = text_.values<std::int64_t>(*ends, text_.triangles);
    const ArrayText* body = text_.find("CellData", "body");
    const std::vector<std::int32_t> of = body ? text_.values<std::int32_t>(*body, text_.triangles)
                                              : std::vector<std::int32_t>();
    std::int64_t start = 0;
    for (std::size_t i = 0; i < end.size(); ++i) {
      if (end[i] < start || end[i] > std::int64_t(corner.size())) text_.damaged("polygon offsets do not increase");
      for (std::int64_t k = start + 2; k < end[i]; ++k)
        add_triangle(table, corner[std::size_t(start)], corner[std::size_t(k - 1)], corner[std::size_t(k)],
                     of.empty() ? 0 : of[i]);
      start = end[i];
    }
    return table;
  }

 private:
  const ArrayText* points_array() const {
    for (const ArrayText& a : text_.arrays) if (a.section == "Points") return &a;
    return nullptr;
  }

  template <class T>
  void copy(const std::string& name, T* values) const {
    const std::vector<T> found = text_.values<T>(*text_.find("PointData", name), text_.points);
    if (!found.empty()) std::memcpy(values, found.data(), found.size() * sizeof(T));
  }

  void add_triangle(TriangleTable& table, std::int64_t a, std::int64_t b, std::int64_t c, std::int32_t body) const {
    const auto count = std::int64_t(positions_.size());
    for (const std::int64_t v : {a, b, c})
      if (v < 0 || v >= count)
        text_.damaged("a polygon names vertex " + std::to_string(v) + " of " + std::to_string(count));
    table.triangle.push_back({std::int32_t(a), std::int32_t(b), std::int32_t(c)});
    table.body.push_back(body);
  }

  VtpText text_;
  std::vector<Vec3d> positions_;
};

}  // namespace

std::unique_ptr<PointSource> open_plain_vtp(const std::string& path) {
  try {
    return std::make_unique<PlainVtp>(path);
  } catch (const OtherFlavour&) {
    return nullptr;
  }
}

}  // namespace gdesp
