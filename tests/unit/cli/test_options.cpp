// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "cli/cli.hpp"

namespace gdesp::cli {
namespace {

namespace po = boost::program_options;

class Options : public ::testing::Test {
 protected:
  po::options_description options{"Options"};
  po::positional_options_description positional;

  void SetUp() override {
    options.add_options()("output,o", po::value<std::string>(), "where to");
    options.add_options()("device", po::value<std::string>()->default_value("auto"), "where it runs");
    options.add_options()("threads", po::value<int>(), "how many");
    options.add_options()("set", po::value<std::vector<std::string>>(), "overrides");
    options.add_options()("scene", po::value<std::string>()->required(), "input");
    options.add(common_options());
    positional.add("scene", 1);
  }
  po::variables_map given(const std::vector<std::string>& arguments) { return parse(arguments, options, positional); }
  std::string refusal(const std::vector<std::string>& arguments) {
    try {
      apply_common(given(arguments));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(Options, arrive) {
  const po::variables_map vm = given({"lake.toml", "-o", "x.case", "--set", "a=1", "--set", "b=-2", "--threads=2"});
  EXPECT_EQ(vm["scene"].as<std::string>(), "lake.toml");
  EXPECT_EQ(vm["output"].as<std::string>(), "x.case");
  EXPECT_EQ(vm["device"].as<std::string>(), "auto");
  EXPECT_EQ(vm["threads"].as<int>(), 2);
  EXPECT_EQ(vm["set"].as<std::vector<std::string>>(), (std::vector<std::string>{"a=1", "b=-2"}));
}

TEST_F(Options, a_dash_is_a_name) { EXPECT_EQ(given({"-"})["scene"].as<std::string>(), "-"); }

TEST_F(Options, mistakes_are_usage_errors_with_help) {
  const std::string message = refusal({"lake.toml", "--devise", "cpu"});
  EXPECT_TRUE(has(message, "--devise") && has(message, "did you mean --device?") && has(message, "--help")) << message;
  EXPECT_FALSE(has(refusal({"lake.toml", "--zzzzzzzz"}), "did you mean"));
  EXPECT_TRUE(has(refusal({"a", "b"}), "too many arguments"));
  EXPECT_TRUE(has(refusal({}), "scene"));
  EXPECT_TRUE(has(refusal({"a", "--threads", "many"}), "many"));
  EXPECT_TRUE(has(refusal({"a", "--output"}), "output"));
  EXPECT_TRUE(has(refusal({"a", "--quiet", "--verbose"}), "contradict"));
  EXPECT_TRUE(has(refusal({"a", "--log-format", "xml"}), "expected text or json"));
}

/// An abbreviation would change its meaning when options are added.
TEST_F(Options, abbreviations_are_not_guessed) {
  EXPECT_TRUE(has(refusal({"lake.toml", "--devic", "cpu"}), "did you mean --device?"));
}

TEST_F(Options, help_and_version_need_nothing_else) {
  EXPECT_TRUE(given({"--help"}).count("help"));
  EXPECT_TRUE(given({"--version"}).count("version"));
  set_version_details([] { return std::string("devices: none"); });
  ::testing::internal::CaptureStdout();
  EXPECT_TRUE(answer_help_or_version(given({"--version"}), "", options, ""));
  const std::string version = ::testing::internal::GetCapturedStdout();
  set_version_details({});
  EXPECT_TRUE(has(version, "0.") && has(version, "built by") && has(version, "devices: none\n")) << version;
  ::testing::internal::CaptureStdout();
  EXPECT_TRUE(answer_help_or_version(given({"-h"}), "usage: probe SCENE", options, "example: probe lake.toml"));
  const std::string help = ::testing::internal::GetCapturedStdout();
  EXPECT_TRUE(help.starts_with("usage: probe SCENE\n")) << help;
  EXPECT_TRUE(help.ends_with("example: probe lake.toml\n")) << help;
  EXPECT_TRUE(has(help, "--device") && has(help, "--log-format")) << help;
  EXPECT_FALSE(answer_help_or_version(given({"x"}), "", options, ""));
}

TEST(ParseOverride, key_and_value) {
  EXPECT_EQ(parse_override("resolution.dp=5").key, "resolution.dp");
  EXPECT_EQ(parse_override("resolution.dp=5").value, "5");
  EXPECT_EQ(parse_override(" a = [1, 2] ").value, "[1, 2]");
  EXPECT_EQ(parse_override("title=a=b").value, "a=b");
  EXPECT_EQ(parse_override("a=").value, "");
  EXPECT_THROW(parse_override("resolution.dp"), Error);
  EXPECT_THROW(parse_override("=5"), Error);
}

}  // namespace
}  // namespace gdesp::cli
