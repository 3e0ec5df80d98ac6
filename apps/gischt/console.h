// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"

namespace gischt {

// Connects a job to the terminal: progress with the time left and messages go to stderr, results to
// stdout, and Ctrl-C or SIGTERM cancels the job (a second one ends the program at once). One at a
// time.
class Console {
  public:
    Console(CommandContext& context);
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;
};

// "1 min 05 s", "12 s", "2 h 03 min".
std::string duration_text(double seconds);

}  // namespace gischt
