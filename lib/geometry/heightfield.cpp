// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/heightfield.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "core/error.hpp"

namespace gdesp::geometry {

double sample(const Heightfield& f, double x, double y) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double u = (x - f.x0) / f.dx, v = (y - f.y0) / f.dy;
  if (!(u >= 0.0 && v >= 0.0 && u <= f.nx - 1 && v <= f.ny - 1)) return nan;
  const int i = std::min(static_cast<int>(u), std::max(0, f.nx - 2));
  const int j = std::min(static_cast<int>(v), std::max(0, f.ny - 2));
  const double a = u - i, b = v - j;
  const double z00 = f.at(i, j), z11 = f.at(std::min(i + 1, f.nx - 1), std::min(j + 1, f.ny - 1));
  if (a >= b) {
    const double z10 = f.at(std::min(i + 1, f.nx - 1), j);
    return a == 0.0 ? z00 : z00 + a * (z10 - z00) + (b > 0.0 ? b * (z11 - z10) : 0.0);
  }
  const double z01 = f.at(i, std::min(j + 1, f.ny - 1));
  return z00 + b * (z01 - z00) + (a > 0.0 ? a * (z11 - z01) : 0.0);
}

TriangleMesh to_mesh(const Heightfield& f, const Box* box) {
  TriangleMesh mesh;
  const Heightfield* field = &f;
  Heightfield part;
  if (box) {
    part = crop(f, *box);
    field = &part;
  }
  const auto node = [&](int i, int j) { return static_cast<std::size_t>(j) * field->nx + i; };
  std::vector<std::int32_t> index(field->z.size(), -1);
  for (int j = 0; j < field->ny; ++j) {
    for (int i = 0; i < field->nx; ++i) {
      const double z = field->at(i, j);
      if (!std::isfinite(z)) continue;
      index[node(i, j)] = static_cast<std::int32_t>(mesh.vertex.size());
      mesh.vertex.push_back({field->x0 + i * field->dx, field->y0 + j * field->dy, z});
    }
  }
  for (int j = 0; j + 1 < field->ny; ++j) {
    for (int i = 0; i + 1 < field->nx; ++i) {
      const std::int32_t a = index[node(i, j)], b = index[node(i + 1, j)], c = index[node(i + 1, j + 1)],
                         d = index[node(i, j + 1)];
      if (a >= 0 && b >= 0 && c >= 0) mesh.triangle.push_back({a, b, c});
      if (a >= 0 && c >= 0 && d >= 0) mesh.triangle.push_back({a, c, d});
    }
  }
  return mesh;
}

Heightfield crop(const Heightfield& f, const Box& box) {
  const auto low = [](double c, double start, double d, int n) {
    return static_cast<int>(std::clamp(std::floor((c - start) / d), 0.0, static_cast<double>(n - 1)));
  };
  const auto high = [](double c, double start, double d, int n) {
    return static_cast<int>(std::clamp(std::ceil((c - start) / d), 0.0, static_cast<double>(n - 1)));
  };
  const int i0 = low(box.lower.x, f.x0, f.dx, f.nx), i1 = high(box.upper.x, f.x0, f.dx, f.nx);
  const int j0 = low(box.lower.y, f.y0, f.dy, f.ny), j1 = high(box.upper.y, f.y0, f.dy, f.ny);
  Heightfield out;
  out.x0 = f.x0 + i0 * f.dx;
  out.y0 = f.y0 + j0 * f.dy;
  out.dx = f.dx;
  out.dy = f.dy;
  out.nx = i1 - i0 + 1;
  out.ny = j1 - j0 + 1;
  out.z.reserve(static_cast<std::size_t>(out.nx) * out.ny);
  for (int j = j0; j <= j1; ++j) {
    const auto row = f.z.begin() + static_cast<std::ptrdiff_t>(j) * f.nx;
    out.z.insert(out.z.end(), row + i0, row + i1 + 1);
  }
  return out;
}

std::size_t fill_small_gaps(Heightfield& f) {
  constexpr std::size_t most = 64;  // nodes of one gap
  std::vector<char> seen(f.z.size(), 0);
  std::size_t filled = 0;
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * f.nx + i; };
  for (int j = 0; j < f.ny; ++j) {
    for (int i = 0; i < f.nx; ++i) {
      if (seen[index(i, j)] || std::isfinite(f.at(i, j))) continue;
      std::vector<std::pair<int, int>> gap = {{i, j}};
      seen[index(i, j)] = 1;
      bool enclosed = true;
      double sum = 0.0;
      std::size_t rim = 0;
      for (std::size_t k = 0; k < gap.size(); ++k) {
        const auto [a, b] = gap[k];
        for (const auto& [da, db] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int u = a + da, v = b + db;
          if (u < 0 || v < 0 || u >= f.nx || v >= f.ny) {
            enclosed = false;
          } else if (std::isfinite(f.at(u, v))) {
            sum += f.at(u, v);
            ++rim;
          } else if (!seen[index(u, v)]) {
            seen[index(u, v)] = 1;
            gap.push_back({u, v});
          }
        }
      }
      if (!enclosed || gap.size() > most || rim == 0) continue;
      for (const auto& [a, b] : gap) f.at(a, b) = sum / static_cast<double>(rim);
      for (int sweep = 0; sweep < 200; ++sweep) {
        for (const auto& [a, b] : gap)
          f.at(a, b) = 0.25 * (f.at(a - 1, b) + f.at(a + 1, b) + f.at(a, b - 1) + f.at(a, b + 1));
      }
      filled += gap.size();
    }
  }
  return filled;
}

Box bounds(const Heightfield& f) {
  Box box = empty_box();
  for (int j = 0; j < f.ny; ++j) {
    for (int i = 0; i < f.nx; ++i) {
      if (std::isfinite(f.at(i, j))) extend(box, {f.x0 + i * f.dx, f.y0 + j * f.dy, f.at(i, j)});
    }
  }
  return box;
}

void write_esri_ascii(const Heightfield& f, const std::string& path, int decimals) {
  if (std::abs(f.dx - f.dy) > 1e-9 * f.dx) {
    throw Error(ErrorKind::input, path + ": an ESRI ASCII grid needs square cells");
  }
  const std::string aside = path + ".part";
  {
    std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(aside.c_str(), "w"), &std::fclose);
    if (!file) throw Error(ErrorKind::resource, path + ": cannot be written");
    std::fprintf(file.get(),
                 "ncols %d\nnrows %d\nxllcenter %.10g\nyllcenter %.10g\ncellsize %.10g\nNODATA_value -9999\n", f.nx,
                 f.ny, f.x0, f.y0, f.dx);
    for (int j = f.ny - 1; j >= 0; --j) {
      for (int i = 0; i < f.nx; ++i) {
        const double z = f.at(i, j);
        if (std::isfinite(z)) {
          std::fprintf(file.get(), "%s%.*f", i ? " " : "", decimals, z);
        } else {
          std::fprintf(file.get(), "%s-9999", i ? " " : "");
        }
      }
      std::fputc('\n', file.get());
    }
    if (std::ferror(file.get())) throw Error(ErrorKind::resource, path + ": writing failed (disk full?)");
  }
  if (std::rename(aside.c_str(), path.c_str()) != 0) throw Error(ErrorKind::resource, path + ": cannot be written");
}

}  // namespace gdesp::geometry
