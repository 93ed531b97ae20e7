// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/error.hpp"
#include "scene/formula.hpp"
#include "scene_fixture.hpp"

namespace gdesp::test {
namespace {

double at(const std::string& text, const Vec3d& r = {}) { return Formula(text)(r); }

TEST(Formula, follows_the_rules_of_arithmetic) {
  EXPECT_EQ(at("1 + 2*3 - 8/4"), 5.0);
  EXPECT_EQ(at("2^3^2"), 512.0);
  EXPECT_EQ(at("-2^2"), -4.0);
  EXPECT_EQ(at("2*-3"), -6.0);
  EXPECT_EQ(at("(1 + 2)*(3 - 1)"), 6.0);
  EXPECT_EQ(at("1.5e-2*2"), 0.03);
  EXPECT_EQ(at("x - 10*y + 100*z", {1, 2, 3}), 281.0);
}

TEST(Formula, knows_its_functions) {
  EXPECT_DOUBLE_EQ(at("sin(pi/6) + cos(pi) + tanh(x)", {0.3, 0, 0}), 0.5 - 1.0 + std::tanh(0.3));
  EXPECT_DOUBLE_EQ(at("cosh(z)/sinh(1) + sqrt(abs(x))", {-4, 0, 0.5}), std::cosh(0.5) / std::sinh(1.0) + 2.0);
  EXPECT_DOUBLE_EQ(at("exp(log(3)) + tan(0)"), 3.0);
}

TEST(Formula, says_where_it_cannot_be_read) {
  for (const char* text : {"", "1 +", "2x", "sin 3", "(1", "1)", "foo(1)", "1..2", "x y", "sin()"}) {
    try {
      Formula formula(text);
      ADD_FAILURE() << "\"" << text << "\" was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what()).find("character"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(Formula(std::string(100000, '(') + "1"), Error);
  EXPECT_THROW(Formula(std::string(100000, '-') + "1"), Error);
}

TEST(Formula, is_checked_with_the_scene) {
  const TempFolder folder;
  const std::string scene =
      "[resolution]\ndp = 0.1\n[fluid]\nvelocity_x = \"2*u\"\n[[fluid.fill]]\nbox = {lower = [0,0,0], upper = "
      "[1,1,1]}\n";
  try {
    read_scene(folder.write("s.toml", scene), {});
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("fluid.velocity_x"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gdesp::test
