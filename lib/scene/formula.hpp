// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of x, y, z in a scene file, such as "0.1*sin(2*pi*x)": + - * / ^, parentheses, pi and the functions sqrt exp
// log sin cos tan sinh cosh tanh abs.
#pragma once

#include <memory>
#include <string>

#include "core/vec3.hpp"

namespace gdesp {

class Formula {
 public:
  /// Throws Error(input) that shows where the text cannot be read and what is valid.
  explicit Formula(const std::string& text);
  ~Formula();
  Formula(Formula&&) noexcept;
  /// The value at r (m); may be infinite or NaN where the formula is.
  double operator()(const Vec3d& r) const;

  struct Node;

 private:
  std::unique_ptr<Node> root_;
};

}  // namespace gdesp
