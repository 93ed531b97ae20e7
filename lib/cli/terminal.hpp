// SPDX-License-Identifier: GPL-3.0-or-later
// Inside the cli module only: who speaks, how, and the line that a progress bar occupies.
#pragma once

#include <string>

#include "cli/cli.hpp"

namespace gdesp::cli::terminal {

/// The reader of our stdout has gone: the tool ends quietly. No std::exception, so that no library catches it.
struct ClosedPipe {};

void set_tool_name(const std::string& name);
const std::string& tool_name();
Verbosity verbosity();
bool json_log();
bool stderr_is_terminal();

/// Writes to stderr whole; failures are ignored (there is nowhere left to say so).
void write_stderr(const std::string& text);
/// Draws a line without ending it ("" clears it); messages printed meanwhile go above it.
void draw_status_line(const std::string& line);
/// Columns of the terminal on stderr.
int terminal_columns();
/// Writes all bytes to stdout; throws ClosedPipe, or Error(resource) when it cannot be written.
void write_stdout(const std::string& text);
/// Flushes std::cout and tells whether all that was written there arrived; throws as write_stdout.
void finish_stdout();

}  // namespace gdesp::cli::terminal
