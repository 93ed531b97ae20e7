// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtp_writer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <stdexcept>

#include "io/base64.hpp"
#include "io/safe_file.hpp"

namespace gdesp {

static_assert(std::endian::native == std::endian::little, "files are written as they lie in memory");
static_assert(sizeof(Vec3d) == 24 && sizeof(Vec3f) == 12 && sizeof(Vec3<std::int32_t>) == 12);

std::size_t size_of(ScalarType type) {
  switch (type) {
    case ScalarType::float64:
    case ScalarType::int64:
      return 8;
    case ScalarType::uint8:
      return 1;
    default:
      return 4;
  }
}

const char* vtk_name(ScalarType type) {
  switch (type) {
    case ScalarType::float32:
      return "Float32";
    case ScalarType::float64:
      return "Float64";
    case ScalarType::int32:
      return "Int32";
    case ScalarType::uint32:
      return "UInt32";
    case ScalarType::int64:
      return "Int64";
    case ScalarType::uint8:
      return "UInt8";
  }
  return "";
}

namespace {

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

class VtpStream {
 public:
  explicit VtpStream(SafeFile& file) : file_(file), text_(base64_size(block)) {}

  void text(const std::string& words) { file_.write(words); }

  void array(const VtpArray& a, bool with_tuples) {
    const std::uint64_t bytes = std::uint64_t(a.tuples) * std::uint64_t(a.components) * size_of(a.type);
    text("<DataArray type=\"" + std::string(vtk_name(a.type)) + "\" Name=\"" + xml_escaped(a.name) +
         "\" NumberOfComponents=\"" + std::to_string(a.components) + "\" " +
         (with_tuples ? "NumberOfTuples=\"" + std::to_string(a.tuples) + "\" " : "") + "format=\"binary\">\n");
    put(&bytes, sizeof bytes);
    put(a.data, bytes);
    flush();
    text("\n</DataArray>\n");
  }

  void section(const char* name, const std::vector<VtpArray>& arrays, std::size_t tuples, bool field = false) {
    text(std::string("<") + name + ">\n");
    for (const VtpArray& a : arrays) {
      if (!field && a.tuples == 0) continue;
      if (!field && a.tuples != tuples)
        throw std::logic_error("write_vtp: array " + a.name + " has " + std::to_string(a.tuples) + " values for " +
                               std::to_string(tuples));
      array(a, field);
    }
    text(std::string("</") + name + ">\n");
  }

  /// Connectivity 0, 1, ... n-1 without holding it in memory.
  void counting_array(std::size_t n) {
    const std::uint64_t bytes = std::uint64_t(n) * sizeof(std::int32_t);
    text("<DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">\n");
    put(&bytes, sizeof bytes);
    std::vector<std::int32_t> numbers(std::min<std::size_t>(n, block / 4));
    for (std::size_t first = 0; first < n; first += numbers.size()) {
      const std::size_t count = std::min(numbers.size(), n - first);
      std::iota(numbers.begin(), numbers.begin() + std::ptrdiff_t(count), static_cast<std::int32_t>(first));
      put(numbers.data(), count * 4);
    }
    flush();
    text("\n</DataArray>\n");
  }

 private:
  static constexpr std::size_t block = 3 * 4 * 32768;  // bytes; a multiple of 3, so that blocks join seamlessly

  void encode(const unsigned char* bytes, std::size_t count) {
    base64_encode(bytes, count, text_.data());
    file_.write(text_.data(), base64_size(count));
  }

  /// Adds bytes to the array's one base64 stream; up to two wait until the next ones complete their triple.
  void put(const void* data, std::size_t count) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    while (waiting_count_ > 0 && waiting_count_ < 3 && count > 0) {
      waiting_[waiting_count_++] = *bytes++;
      --count;
      if (waiting_count_ == 3) flush();
    }
    while (count >= 3) {
      const std::size_t now = std::min(count / 3 * 3, block);
      encode(bytes, now);
      bytes += now;
      count -= now;
    }
    if (count == 0) return;
    std::memcpy(waiting_, bytes, count % 3);  // none waited here: those before are written
    waiting_count_ = count;
  }

  void flush() {
    encode(waiting_, waiting_count_);
    waiting_count_ = 0;
  }

  unsigned char waiting_[3] = {};
  std::size_t waiting_count_ = 0;
  SafeFile& file_;
  std::vector<char> text_;
};

void write_cells(VtpStream& out, const VtpContent& content, std::size_t points, std::size_t triangles) {
  if (content.triangles) {
    std::vector<std::int32_t> offsets(triangles);
    for (std::size_t i = 0; i < triangles; ++i) offsets[i] = static_cast<std::int32_t>(3 * (i + 1));
    const VtpArray corners{"connectivity", ScalarType::int32, 1, content.triangles->data(), 3 * triangles};
    out.text("<Polys>\n");
    out.array(corners, false);
    out.array(vtp_array("offsets", offsets), false);
    out.text("</Polys>\n");
  } else if (points > 0) {
    const std::vector<std::int32_t> offsets{static_cast<std::int32_t>(points)};
    out.text("<Verts>\n");
    out.counting_array(points);
    out.array(vtp_array("offsets", offsets), false);
    out.text("</Verts>\n");
  }
}

}  // namespace

void write_vtp(const std::string& path, const VtpContent& content) {
  const std::vector<Vec3d>& position = *content.position;
  const std::size_t points = position.size(), triangles = content.triangles ? content.triangles->size() : 0;
  if (points > INT32_MAX || triangles > INT32_MAX / 3)
    throw std::logic_error("write_vtp: more points or triangles than a 32-bit connectivity can name");
  SafeFile file(path);
  VtpStream out(file);
  out.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n");
  out.section("FieldData", content.field, 0, true);
  out.text("<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" +
           (content.triangles || points == 0 ? "0" : "1") + "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" " +
           "NumberOfPolys=\"" + std::to_string(triangles) + "\">\n");
  out.section("PointData", content.points, points);
  out.section("CellData", content.cells, triangles);
  out.text("<Points>\n");
  out.array({"Points", ScalarType::float64, 3, position.data(), points}, false);
  out.text("</Points>\n");
  write_cells(out, content, points, triangles);
  out.text("</Piece>\n</PolyData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace gdesp
