// SPDX-License-Identifier: GPL-3.0-or-later
// Output appears complete or not at all.
#include <sys/resource.h>

#include <csignal>

#include "io/safe_file.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

std::size_t files_in(const std::string& folder) {
  return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(SafeFile, appears_when_committed) {
  const TempFolder folder;
  SafeFile file(folder / "a.txt");
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  file.commit();
  EXPECT_EQ(text_of_file(folder / "a.txt"), "hello");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(SafeFile, leaves_the_old_file_and_no_scraps_when_given_up) {
  const TempFolder folder;
  folder.write("a.txt", "old");
  {
    SafeFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(text_of_file(folder / "a.txt"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(SafeFile, missing_folder_is_a_resource_error) {
  const TempFolder folder;
  expect_error(ErrorKind::resource, {"no/such/a.txt", "cannot be created", "No such file or directory"},
               [&] { write_text_file(folder / "no/such/a.txt", "x"); });
}

TEST(SafeFile, folder_that_may_not_be_written) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TempFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_error(ErrorKind::resource, {"a.txt", "Permission denied"}, [&] { write_text_file(folder / "a.txt", "x"); });
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(SafeFile, full_device_is_a_resource_error) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TempFolder folder;
  // The file that is written aside leads to a device without room.
  std::filesystem::create_symlink("/dev/full", (folder / "a.txt") + ".part-" + std::to_string(::getpid()));
  expect_error(ErrorKind::resource, {"a.txt", "cannot be written", "No space left on device"},
               [&] { write_text_file(folder / "a.txt", "x"); });
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(SafeFile, file_past_the_size_limit_is_a_resource_error) {
  const TempFolder folder;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1024, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  expect_error(ErrorKind::resource, {"a.txt", "cannot be written"},
               [&] { write_text_file(folder / "a.txt", std::string(5000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(ReadTextFile, says_what_is_wrong) {
  const TempFolder folder;
  folder.write("big.txt", std::string(100, 'x'));
  EXPECT_EQ(read_text_file(folder / "big.txt", 100), std::string(100, 'x'));
  expect_error(ErrorKind::input, {"big.txt", "larger"}, [&] { read_text_file(folder / "big.txt", 99); });
  expect_error(ErrorKind::input, {"none.txt", "no such file"}, [&] { read_text_file(folder / "none.txt", 99); });
  expect_error(ErrorKind::input, {"folder"}, [&] { read_text_file(folder.path(), 99); });
}

}  // namespace
}  // namespace gdesp::test
