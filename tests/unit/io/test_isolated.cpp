// SPDX-License-Identifier: GPL-3.0-or-later
// Reading in a child process: what arrives, and what becomes of a reader that fails in any way.
#include <csignal>
#include <thread>

#include "io/isolated.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

class Isolated : public ::testing::Test {
 protected:
  TempFolder folder;
  std::string path = folder.write("points.xyz", "x");

  std::unique_ptr<MemoryPoints> read(const std::function<void(const std::string&, MemoryPoints&)>& reader) {
    return read_isolated(path, "The library", reader);
  }
  void refused(const std::vector<std::string>& parts,
               const std::function<void(const std::string&, MemoryPoints&)>& reader,
               ErrorKind kind = ErrorKind::input) {
    expect_error(kind, parts, [&] { read(reader); });
  }
};

void some_points(const std::string&, MemoryPoints& p) {
  p.position = {{1e15 + 1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  p.columns = {{"velocity", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {}}, {"id", 1, {}, {1, -2, 1LL << 62}}};
  p.fields = {{"time", {0.1}}, {"empty", {}}};
  p.surface.triangle = {{0, 1, 2}};
  p.surface.body = {4};
}

TEST_F(Isolated, points_arrive_whole) {
  const auto p = read(some_points);
  EXPECT_EQ(p->positions().at(0), (Vec3d{1e15 + 1, 2, 3}));
  EXPECT_EQ(p->names(), (std::vector<std::string>{"velocity", "id"}));
  EXPECT_EQ(p->components("velocity"), 3);
  EXPECT_EQ(p->components("none"), 0);
  std::vector<float> velocity(9);
  p->read("velocity", velocity.data());
  EXPECT_EQ(velocity[8], 9.0f);
  std::vector<std::int64_t> id(3);
  p->read("id", id.data());
  EXPECT_EQ(id[2], 1LL << 62);
  EXPECT_EQ(p->field("time"), std::vector<double>{0.1});
  EXPECT_TRUE(p->field("none").empty());
  EXPECT_EQ(p->triangles().vertex.size(), 3u);
  EXPECT_EQ(p->triangles().body.at(0), 4);
}

TEST_F(Isolated, errors_of_the_reader_arrive_as_they_are) {
  refused({"of its own"}, [](const std::string&, MemoryPoints&) { throw Error(ErrorKind::input, "of its own"); });
  refused(
      {"no room"}, [](const std::string&, MemoryPoints&) { throw Error(ErrorKind::resource, "no room"); },
      ErrorKind::resource);
  refused({"points.xyz", "The library", "odd"},
          [](const std::string&, MemoryPoints&) { throw std::runtime_error("odd"); });
  refused({"points.xyz"}, [](const std::string&, MemoryPoints&) { throw 3; });
}

TEST_F(Isolated, crash_is_an_error) {
  refused({"points.xyz", "The library", "crashed (signal 11)"},
          [](const std::string&, MemoryPoints&) { ::raise(SIGSEGV); });
  refused({"crashed (signal 6)"}, [](const std::string&, MemoryPoints&) { std::abort(); });
  refused({"stopped"}, [](const std::string&, MemoryPoints&) { ::_exit(3); });
}

TEST_F(Isolated, memory_without_end_is_an_error) {
  refused({"points.xyz"}, [](const std::string&, MemoryPoints& p) { p.position.resize(std::size_t{1} << 40); });
}

TEST_F(Isolated, points_that_do_not_fit_together_are_refused) {
  refused({"damaged"},
          [](const std::string& f, MemoryPoints& p) { some_points(f, p), p.columns[0].numbers.pop_back(); });
  refused({"damaged"}, [](const std::string& f, MemoryPoints& p) { some_points(f, p), p.surface.triangle[0].y = 3; });
  refused({"damaged"}, [](const std::string& f, MemoryPoints& p) { some_points(f, p), p.surface.body.clear(); });
}

TEST_F(Isolated, a_silent_child) {
  ::testing::internal::CaptureStderr();
  read([](const std::string& f, MemoryPoints& p) {
    std::fputs("noise", stderr);
    some_points(f, p);
  });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Isolated, several_threads_read_at_once) {
  std::vector<std::thread> threads;
  std::atomic<int> sound{0};
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 5; ++k) sound += read(some_points)->size() == 3;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sound, 20);
}

}  // namespace
}  // namespace gdesp::test
