// SPDX-License-Identifier: GPL-3.0-or-later
// What people see on stderr when it is no terminal.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/cli.hpp"

namespace gdesp::cli {
namespace {

template <class Action>
std::string said(Action action) {
  ::testing::internal::CaptureStderr();
  action();
  return ::testing::internal::GetCapturedStderr();
}

class Messages : public ::testing::Test {
 protected:
  void TearDown() override { set_verbosity(Verbosity::normal, false); }
  static void speak() {
    info("one");
    detail("two");
    warning("three");
    error("four");
  }
};

TEST_F(Messages, verbosity_chooses) {
  set_verbosity(Verbosity::quiet, false);
  EXPECT_EQ(said(speak), "gdesp: warning: three\ngdesp: error: four\n");
  set_verbosity(Verbosity::normal, false);
  EXPECT_EQ(said(speak), "gdesp: one\ngdesp: warning: three\ngdesp: error: four\n");
  set_verbosity(Verbosity::verbose, false);
  EXPECT_EQ(said(speak), "gdesp: one\ngdesp: two\ngdesp: warning: three\ngdesp: error: four\n");
}

TEST_F(Messages, json_is_one_object_a_line) {
  set_verbosity(Verbosity::normal, true);
  const std::string line = said([] { warning("a \"b\"\nc \xff"); });
  const nlohmann::json object = nlohmann::json::parse(line);
  EXPECT_EQ(object["level"], "warning");
  EXPECT_EQ(object["tool"], "gdesp");
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
}

TEST_F(Messages, progress_without_a_terminal_is_a_line_every_tenth) {
  const std::string text = said([] {
    Progress progress("filling");
    for (int i = 0; i <= 1000; ++i) progress.update(i / 1000.0, "t = 1 s");
    progress.done("12 grains");
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11) << text;
  EXPECT_NE(text.find("gdesp: filling  10 %  t = 1 s  ETA 00:00\n"), std::string::npos) << text;
  EXPECT_NE(text.find("gdesp: filling: done in 00:00, 12 grains\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos) << "no drawing into a file";
}

TEST_F(Messages, progress_keeps_quiet_when_asked) {
  set_verbosity(Verbosity::quiet, false);
  EXPECT_EQ(said([] {
              Progress progress("filling");
              progress.update(0.5);
              progress.done();
            }),
            "");
}

TEST_F(Messages, progress_bears_odd_fractions) {
  const std::string text = said([] {
    Progress progress("filling");
    progress.update(-1.0);
    progress.update(std::nan(""));
    progress.update(7.0);
  });
  EXPECT_NE(text.find("100 %"), std::string::npos) << text;
}

TEST_F(Messages, progress_as_json) {
  set_verbosity(Verbosity::normal, true);
  const std::string text = said([] { Progress("filling").update(0.5, "n"); });
  const nlohmann::json object = nlohmann::json::parse(text);
  EXPECT_EQ(object["level"], "progress");
  EXPECT_EQ(object["fraction"], 0.5);
}

}  // namespace
}  // namespace gdesp::cli
