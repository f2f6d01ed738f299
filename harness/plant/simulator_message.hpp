// What a simulator says of a model, as one of our error messages.
#pragma once

#include <string>

namespace attest {

// The line that it names ("Element 'geom', line 12", "line = 12", "Line number=12"); 0 when it
// names none.
int line_in(const std::string& simulator_message);

// Without line breaks.
std::string one_line(std::string simulator_message);

}  // namespace attest
