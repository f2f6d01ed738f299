// Converts a simulator's message about a model to an error message of attest.
#pragma once

#include <string>

namespace attest {

// The line in the message ("Element 'geom', line 12", "line = 12", "Line number=12"); 0 if it has
// no line.
int line_in(const std::string& simulator_message);

// The message on one line.
std::string on_one_line(std::string simulator_message);

}  // namespace attest
