// std::string for attest and the libraries that it loads. Each source of C++20 has functions of
// std::string, and the linker keeps those of the first. Without this source they would be those of
// arguments.cpp, which is not optimised, and the suite without flights would take 1.4 times as
// long.
#include <string>

template class std::basic_string<char>;
