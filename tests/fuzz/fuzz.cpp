#include "tests/fuzz/fuzz.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <unistd.h>

namespace attest::fuzz {

namespace fs = std::filesystem;

void require(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

const fs::path& folder() {
  static const fs::path made = [] {
    const fs::path path = fs::temp_directory_path() / ("fuzz." + std::to_string(::getpid()));
    fs::create_directories(path);
    return path;
  }();
  return made;
}

fs::path write(const fs::path& relative, std::string_view text) {
  const fs::path path = folder() / relative;
  std::ofstream file(path, std::ios::binary);
  if (!file) {
    fs::create_directories(path.parent_path());
    file.open(path, std::ios::binary);
  }
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  require(static_cast<bool>(file.flush()), "the input is written to " + path.string());
  return path;
}

void require_readable(std::string_view message) {
  const auto is_control = [](char c) {
    return (c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == 127;
  };
  const std::string shown(message);
  require(std::none_of(message.begin(), message.end(), is_control),
          "no control characters in the message " + shown);
  require(!message.empty() && message.front() != '\n' && message.back() != '\n' &&
              message.find("\n\n") == std::string_view::npos,
          "no empty line in the message " + shown);
}

void require_readable(const Error& error, const fs::path& file) {
  require(error.file == file.string(), "the error names its file: " + error.to_string());
  require(error.line >= 0 && error.column >= 0, "the error has a place: " + error.to_string());
  require_readable(error.message);
}

}  // namespace attest::fuzz
