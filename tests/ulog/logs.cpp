// Writes the logs that both readers must read the same way: ten that are made byte by byte, one for
// each feature of the format, and two by attest's writer.
//
//     attest_ulog_logs FOLDER
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>

#include "harness/ulog/writer.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest::ulog {
namespace {

const std::string pose = "pose:uint64_t timestamp;float[3] x;bool valid;uint8_t[3] _padding0;";

std::string pose_at(std::uint64_t time, float x) {
  return raw(time, x, -x, 0.1f * x, std::uint8_t{x > 1});
}

Crafted started(Crafted log = Crafted().flag_bits()) {
  return log.format(pose).subscribe(0, "pose");
}

Crafted version_0() { return started(Crafted(0, 987654321)).data(0, pose_at(1, 1.5f)); }

Crafted version_1() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Crafted log = started().data(0, pose_at(1, 1.5f) + std::string(3, '\x55'));  // with padding
  log.data(0, pose_at(2, inf)).data(0, pose_at(~std::uint64_t{0}, -0.0f));
  return log.data(0, pose_at(4, std::numeric_limits<float>::quiet_NaN())).message('z', "new");
}

// foxglove requires a timestamp in nested formats, too.
Crafted nested() {
  Crafted log;
  log.flag_bits().format("top:uint64_t timestamp;middle[2] m;inner i;int8_t end;");
  log.format("middle:uint64_t timestamp;inner[3] i;int16_t s;uint8_t[6] _padding0;");
  log.format("inner:uint64_t timestamp;double d;uint16_t[2] u;uint8_t[4] _padding0;");
  log.subscribe(5, "top");
  const auto inner = [](double d) {
    return raw(std::uint64_t{3}, d, std::uint16_t{7}, std::uint16_t{65535}, std::uint32_t{0});
  };
  const auto middle = [&](double d) {
    return raw(std::uint64_t{2}) + inner(d) + inner(-d) + inner(1 / d) + raw(std::int16_t{-5}) +
           std::string(6, '\0');
  };
  return log.data(5, raw(std::uint64_t{1}) + middle(3) + middle(1e300) + inner(5e-324) + '\x80');
}

Crafted arrays() {
  Crafted log;
  log.flag_bits().format(
      "all:uint64_t timestamp;int64_t[2] a;double[2] b;int32_t[2] c;uint32_t[2] d;float[2] e;"
      "int16_t[2] f;uint16_t[2] g;int8_t[2] h;uint8_t[2] i;bool[2] j;char[6] k;char l;");
  log.subscribe(1, "all");
  std::string bytes = raw(std::uint64_t{1}, std::numeric_limits<std::int64_t>::min(),
                          std::numeric_limits<std::int64_t>::max(), 0.1, -1e-310);
  bytes += raw(-1, std::numeric_limits<int>::max(), 0xffffffffu, 0u, 1e-45f, 3.4e38f);
  bytes += raw(std::int16_t{-32768}, std::int16_t{32767}, std::uint16_t{65535}, std::uint16_t{1});
  bytes += raw(std::int8_t{-128}, std::int8_t{127}, std::uint8_t{255}, std::uint8_t{0});
  return log.data(1, bytes + std::string("\x01\x02"
                                         "a\"\xC3\xA9\n\0z",
                                         9));
}

Crafted instances() {
  Crafted log = started().subscribe(1, "pose", 1).subscribe(300, "pose", 255);
  log.data(300, pose_at(1, 3.0f)).data(0, pose_at(2, 4.0f)).data(1, pose_at(3, 5.0f));
  return log.message('R', raw(std::uint16_t{1})).data(300, pose_at(4, 6.0f));
}

Crafted appended() {
  const auto build = [](std::uint64_t first, std::uint64_t second) {
    Crafted log = started(Crafted().flag_bits(first == 0 ? 0 : 1, first, second));
    return log.data(0, pose_at(1, 1.0f))
        .append(Crafted().data(0, pose_at(2, 2.0f)).bytes().substr(16, 9));
  };
  const std::uint64_t first = build(0, 0).size();  // the last message is cut off there
  const Crafted part = Crafted().data(0, pose_at(3, 3.0f)).log('2', 4, "hard fault");
  Crafted log = build(first, first + part.size() - 16).append(part.bytes().substr(16));
  return log.data(0, pose_at(5, 5.0f));
}

Crafted dropouts() {
  Crafted log = started().data(0, pose_at(1, 1.0f)).message('O', raw(std::uint16_t{0}));
  log.message('O', raw(std::uint16_t{65535})).sync().data(0, pose_at(2, 2.0f));
  return log.message('O', raw(std::uint16_t{40})).sync();
}

Crafted parameters() {
  Crafted log =
      Crafted().flag_bits().value('P', "float A", raw(0.1f)).value('P', "int32_t B", raw(-7));
  log.value('Q', 1, "float C", raw(-0.0f)).value('P', "float A", raw(0.2f));
  log = started(log).data(0, pose_at(1, 1.0f));
  log.value('P', "float A", raw(0.3f)).value('Q', 3, "int32_t B", raw(2147483647));
  return log.data(0, pose_at(2, 1.0f));
}

Crafted information() {
  Crafted log = Crafted().flag_bits().value('I', "char[4] sys_name", "P\xC3\xA4X");
  log.value('I', "uint32_t ver_release", raw(0xff010d00u)).value('I', "int32_t utc", raw(-3600));
  log.value('I', "uint64_t big", raw(~std::uint64_t{0})).value('I', "bool on", raw('\1'));
  log.value('M', 0, "char[3] perf", "one").value('M', 1, "char[3] perf", "two");
  log.value('M', 0, "float[2] pair", raw(1.0f, 0.3f));
  return started(log).data(0, pose_at(1, 1.0f)).value('M', 1, "char[2] perf", "xy");
}

Crafted log_lines() {
  Crafted log =
      started().data(0, pose_at(1, 1.0f)).log('6', 5, "Takeoff detected\t").log('0', 6, "");
  log.message('C', "4" + raw(std::uint16_t{65535}, std::uint64_t{7}) + "tagged \xE2\x82\xAC");
  return log.data(0, pose_at(2, 1.0f));
}

template <typename T>
void must(const Result<T>& done) {
  if (done) return;
  std::cerr << done.error().to_string() << '\n';
  std::exit(2);
}

// By the writer: every message, and enough data for sync messages.
void write_log(const std::filesystem::path& path, int samples) {
  auto writer = Writer::open(path, 1'000'000);
  must(writer);
  must(writer->info("sys_name", "attest"));
  must(writer->parameter("MC_ROLL_P", 6.5f));
  must(writer->parameter("MAV_TYPE", 2));
  must(writer->define(
      "rates:uint64_t timestamp;double t;float[3] rates;int16_t n;bool on;char[3] c;"));
  must(writer->define("control/state-1:uint64_t timestamp;uint64_t sample;int8_t[5] x;"));
  must(writer->subscribe("rates"));
  must(writer->subscribe("control/state-1"));
  must(writer->subscribe("rates", 2));
  for (int i = 0; i < samples; ++i) {
    const auto time = static_cast<std::uint64_t>(1000 * i);
    const auto x = static_cast<float>(i) / 3;
    must(writer->data(
        i % 3 == 0 ? 2 : 0,
        raw(time, 1.0 / i, x, -x, 1e-30f * x, static_cast<std::int16_t>(-i), i % 2 == 0) + "abc"));
    must(writer->data(1, raw(time, ~time) + "\x80\x7f\x01\xff\x02"));
    if (i % 50 == 0) must(writer->log('4', time, "line " + std::to_string(i)));
    if (i % 70 == 0) must(writer->dropout(static_cast<std::uint16_t>(i)));
    if (i % 90 == 0) must(writer->parameter("MC_ROLL_P", x));
  }
  must(writer->commit());
}

int write_logs(const std::filesystem::path& folder) {
  const std::map<std::string, Crafted> logs = {
      {"version_0", version_0()}, {"version_1", version_1()},   {"nested", nested()},
      {"arrays", arrays()},       {"instances", instances()},   {"appended", appended()},
      {"dropouts", dropouts()},   {"parameters", parameters()}, {"information", information()},
      {"log_lines", log_lines()}};
  for (const auto& [name, log] : logs) {
    std::ofstream file(folder / (name + ".ulg"), std::ios::binary);
    file << log.bytes();
  }
  write_log(folder / "written_short.ulg", 3);
  write_log(folder / "written_long.ulg", 5000);
  return 0;
}

}  // namespace
}  // namespace attest::ulog

int main(int argc, char** argv) {
  if (argc == 2) return attest::ulog::write_logs(argv[1]);
  std::cerr << "usage: attest_ulog_logs FOLDER\n";
  return 2;
}
