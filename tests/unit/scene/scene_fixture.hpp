// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "support/temp_folder.hpp"

namespace gdesp::test {

/// A test that reads scenes out of text.
class SceneTest : public ::testing::Test {
 protected:
  TempFolder folder;

  Scene read(const std::string& text, const std::vector<Override>& overrides = {}) {
    return read_scene(folder.write("lake.toml", text), overrides);
  }

  /// Message of the Error that reading throws; fails the test when it throws none or another kind.
  std::string refusal(const std::string& text, const std::vector<Override>& overrides = {},
                      ErrorKind kind = ErrorKind::input) {
    try {
      read(text, overrides);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "accepted:\n" << text;
    return {};
  }
};

/// True when all parts occur in the text; says which does not.
inline ::testing::AssertionResult mentions(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "no \"" << part << "\" in: " << text;
  return ::testing::AssertionSuccess();
}

}  // namespace gdesp::test
