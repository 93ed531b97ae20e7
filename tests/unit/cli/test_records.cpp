// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sstream>

#include "cli/cli.hpp"

namespace gdesp::cli {
namespace {

using nlohmann::ordered_json;

std::string written(const ordered_json& record) {
  ::testing::internal::CaptureStdout();
  write_record(record);
  return ::testing::internal::GetCapturedStdout();
}

TEST(Records, one_line_each_in_the_order_given) {
  EXPECT_EQ(written({{"record", "case"}, {"path", "a.case"}, {"count", 3}}),
            "{\"record\":\"case\",\"path\":\"a.case\",\"count\":3}\n");
  EXPECT_EQ(written({{"record", "x"}, {"text", "two\nlines"}}), "{\"record\":\"x\",\"text\":\"two\\nlines\"}\n");
}

TEST(Records, bytes_that_are_no_text_do_not_stop_the_tool) {
  const std::string line = written({{"record", "case"}, {"path", "a\xff.case"}});
  EXPECT_TRUE(ordered_json::accept(line)) << line;
}

TEST(Records, come_back_unharmed) {
  const ordered_json first{{"record", "unknown"}, {"z", 1.0e-17}, {"a", {1, 2, nullptr}}, {"n", 12345678901234567}};
  std::istringstream in(written(first));
  int line = 0;
  const std::optional<ordered_json> back = read_record(in, line);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->dump(), first.dump());
  EXPECT_FALSE(read_record(in, line));
}

TEST(Records, empty_lines_are_passed_over_and_the_last_needs_no_end) {
  std::istringstream in("\n  \r\n{\"a\":1}\n\n{\"a\":2}");
  int line = 0;
  EXPECT_EQ((*read_record(in, line))["a"], 1);
  EXPECT_EQ(line, 3);
  EXPECT_EQ((*read_record(in, line))["a"], 2);
  EXPECT_EQ(line, 5);
  EXPECT_FALSE(read_record(in, line));
}

TEST(Records, garbage_is_an_input_error_that_names_its_line) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  const std::string nested = [] {
    std::string text = "1";
    for (int i = 0; i < 200; ++i) text = "{\"a\":" + text + "}";
    return text;
  }();
  for (const std::string& bad : {std::string("hello"), std::string("{\"a\":"), std::string("[1]"), std::string("3"),
                                 std::string("null"), std::string("{\"a\":1} x"), std::string("\xff\xfe\x01"),
                                 std::string("{\"a\":\"\xff\"}"), std::string("a\0b", 3), deep, nested}) {
    std::istringstream in("{\"a\":1}\n" + bad + "\n");
    int line = 0;
    ASSERT_TRUE(read_record(in, line));
    try {
      read_record(in, line);
      ADD_FAILURE() << "accepted: " << bad.substr(0, 40);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_TRUE(std::string(error.what()).starts_with("line 2: ")) << error.what();
      EXPECT_LT(std::string(error.what()).size(), 200u);
    }
  }
}

TEST(Records, a_line_without_end_takes_no_more_than_its_limit) {
  struct Endless : std::streambuf {
    char letter = 'x';
    int_type underflow() override {
      setg(&letter, &letter, &letter + 1);
      return letter;
    }
  } endless;
  std::istream in(&endless);
  int line = 0;
  EXPECT_THROW(read_record(in, line), Error);
}

}  // namespace
}  // namespace gdesp::cli
