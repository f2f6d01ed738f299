// Reading a ULog against the least cost of reading: the same file in blocks, each byte copied once.
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "harness/ulog/reader.hpp"
#include "harness/ulog/writer.hpp"

namespace attest::bench {
namespace {

// A log of 32 MB with the topics of a controller, at the sizes that PX4 gives them. It is removed
// when the program ends.
class LogFile {
 public:
  LogFile()
      : path_(std::filesystem::temp_directory_path() / ("bench." + std::to_string(::getpid()))) {
    auto writer = *ulog::Writer::open(path_, 0);
    (void)writer.define("control_state:uint64_t timestamp;float[4] q;float[15] x;");
    (void)writer.define(
        "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;");
    (void)writer.define("actuator_controls_0:uint64_t timestamp;uint64_t sample;float[8] control;");
    constexpr std::size_t bytes[] = {84, 20, 48};
    for (const char* topic : {"control_state", "vehicle_rates_setpoint", "actuator_controls_0"}) {
      (void)writer.subscribe(topic);
    }
    const std::string data(84, 'x');
    for (int i = 0; i < 192'000; ++i) {
      for (std::uint16_t id = 0; id < 3; ++id) (void)writer.data(id, data.substr(0, bytes[id]));
    }
    (void)writer.commit();
  }
  ~LogFile() { std::filesystem::remove(path_); }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const std::filesystem::path& log_path() {
  static const LogFile file;
  return file.path();
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(log_path())));
}

void blocks_copied(benchmark::State& state) {
  std::vector<char> block(std::size_t{1} << 20), copy(block.size());
  log_path();
  for (auto _ : state) {
    const int file = *open_regular_file(log_path());
    for (ssize_t count = 1; count > 0;) {
      count = ::read(file, block.data(), block.size());
      if (count > 0) std::memcpy(copy.data(), block.data(), static_cast<std::size_t>(count));
      benchmark::DoNotOptimize(copy.data());
      benchmark::ClobberMemory();
    }
    ::close(file);
  }
  count_bytes(state);
}

// Every message, and one number of each data message.
void messages_read(benchmark::State& state) {
  log_path();
  for (auto _ : state) {
    auto reader = *ulog::Reader::open(log_path());
    std::vector<ulog::Column> columns;
    columns.push_back(*reader.find("control_state", 0, "q[3]"));
    columns.push_back(*reader.find("vehicle_rates_setpoint", 0, "yaw"));
    columns.push_back(*reader.find("actuator_controls_0", 0, "control[2]"));
    double sum = 0;
    ulog::Message message;
    while (*reader.next(message)) {
      const auto* const data = std::get_if<ulog::Data>(&message);
      if (data) sum += columns[data->subscription->index].of(*data);
    }
    benchmark::DoNotOptimize(sum);
  }
  count_bytes(state);
}

BENCHMARK(blocks_copied)->Name("ulog/blocks");
BENCHMARK(messages_read)->Name("ulog/read");

}  // namespace
}  // namespace attest::bench
