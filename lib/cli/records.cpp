// SPDX-License-Identifier: GPL-3.0-or-later
// Records between tools: one JSON object a line.
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "cli/terminal.hpp"

namespace gdesp::cli {
namespace {

constexpr std::size_t longest_line = 16u << 20;  // bytes; a record is some hundred
constexpr int deepest_nesting = 64;

/// One line without its end; false at the end of the stream.
bool read_line(std::istream& in, std::string& line, int line_number) {
  line.clear();
  std::streambuf& buffer = *in.rdbuf();
  for (int c = buffer.sbumpc();; c = buffer.sbumpc()) {
    if (c == std::char_traits<char>::eof()) {
      in.setstate(std::ios::eofbit);
      return !line.empty();
    }
    if (c == '\n') return true;
    if (line.size() >= longest_line)
      throw Error(ErrorKind::input, "line " + std::to_string(line_number) + ": longer than 16 MiB, not a record");
    line += static_cast<char>(c);
  }
}

std::string excerpt(const std::string& line) {
  std::string text = line.substr(0, 40);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
  return "\"" + text + (line.size() > 40 ? "...\"" : "\"");
}

}  // namespace

namespace terminal {

void write_stdout(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (n >= 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno == EPIPE) {
      throw ClosedPipe{};
    } else if (errno != EINTR) {
      throw Error(ErrorKind::resource, std::string("standard output cannot be written: ") + std::strerror(errno));
    }
  }
}

void finish_stdout() {
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  if (std::cout.good() && !std::ferror(stdout)) return;
  // The failure may lie back, and errno with it: ask the pipe itself whether its reader has gone.
  const int why = errno;
  pollfd pipe{STDOUT_FILENO, POLLOUT, 0};
  if (why == EPIPE || (::poll(&pipe, 1, 0) == 1 && (pipe.revents & POLLERR) != 0)) throw ClosedPipe{};
  throw Error(ErrorKind::resource, "standard output cannot be written" +
                                       (why == 0 ? std::string() : std::string(": ") + std::strerror(why)));
}

}  // namespace terminal

bool stdout_is_terminal() { return ::isatty(STDOUT_FILENO) == 1; }

void write_record(const nlohmann::ordered_json& record) {
  terminal::finish_stdout();
  terminal::write_stdout(record.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::optional<nlohmann::ordered_json> read_record(std::istream& in, int& line_number) {
  std::string line;
  while (read_line(in, line, ++line_number)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    bool deep = false;
    const auto shallow = [&deep](int depth, nlohmann::json::parse_event_t, nlohmann::ordered_json&) {
      deep = deep || depth > deepest_nesting;
      return !deep;
    };
    const nlohmann::ordered_json record = nlohmann::ordered_json::parse(line, shallow, false);
    if (deep || !record.is_object())
      throw Error(ErrorKind::input, "line " + std::to_string(line_number) + ": found " + excerpt(line) +
                                        ", expected a record: one JSON object a line");
    return record;
  }
  return std::nullopt;
}

}  // namespace gdesp::cli
