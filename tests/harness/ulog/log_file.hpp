// Reads a crafted log in a test, as one line of text for each message.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/ulog/reader.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest::ulog {

// A message as text, such as "D pose/1 timestamp=7 q[0]=1 q[1]=0.5" or "I sys_name=PX4".
std::string line_of(const Message& message);

// What a reader makes of a log.
struct LogLines {
  std::vector<std::string> lines;
  Damage damage;
  std::uint64_t unknown_messages = 0;
};

class LogFile : public testing::Test {
 protected:
  std::string write(const Crafted& log) { return directory_.write("a.ulg", log.bytes()); }
  Reader open(const Crafted& log);
  LogLines read(const Crafted& log);
  std::string error_of(const Crafted& log);  // without the directory; empty: it can be opened

  TemporaryDirectory directory_;
};

// Reads to the end. REQUIRES: no read of the file fails.
LogLines lines_of(Reader& reader);

}  // namespace attest::ulog
