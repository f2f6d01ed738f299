// The functions of std::string, compiled with optimisation, for attest and the libraries that it
// loads. Many objects contain these functions, and the linker keeps those of the first object.
// Without this file that would be arguments.cpp, which is compiled without optimisation, and the
// suite without flights would take 1.4 times as long.
#include <string>

template class std::basic_string<char>;
