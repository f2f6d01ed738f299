// What is written is read back with the same bits.
#include <cstring>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/ulog/reader.hpp"
#include "harness/ulog/writer.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest::ulog {
namespace {

struct Topic {
  std::string name;
  std::string definition;
  std::size_t bytes;
};

std::string arbitrary_bytes(std::size_t count) {
  std::string bytes;
  while (bytes.size() < count) {
    bytes += static_cast<char>(*rc::gen::resize(100, rc::gen::arbitrary<std::uint8_t>()));
  }
  return bytes;
}

Topic arbitrary_topic(std::size_t number) {
  Topic topic{"t" + std::to_string(number), "", sizeof(std::uint64_t)};
  topic.definition = topic.name + ":uint64_t timestamp;";
  auto types = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 12));
  std::stable_sort(types.begin(), types.end(), [](int a, int b) {
    return bytes_of(static_cast<Type>(a)) > bytes_of(static_cast<Type>(b));
  });
  for (std::size_t i = 0; i < types.size(); ++i) {
    const auto type = static_cast<Type>(types[i]);
    const auto count = *rc::gen::inRange<std::size_t>(0, 5);  // 0: no array
    const std::string brackets = count == 0 ? "" : "[" + std::to_string(count) + "]";
    topic.definition += std::string(name_of(type)) + brackets + " f" + std::to_string(i) + ";";
    topic.bytes += std::max<std::size_t>(count, 1) * bytes_of(type);
  }
  return topic;
}

// A message of any type as one string of bytes.
struct Flat {
  std::string operator()(const Data& each) const {
    return "D" + each.subscription->topic + std::to_string(each.subscription->multi_id) +
           std::string(each.bytes);
  }
  std::string operator()(const KeyValue& each) const {
    return each.kind + std::string(each.name) + std::string(name_of(each.type)) +
           std::string(each.bytes);
  }
  std::string operator()(const LogLine& each) const {
    return "L" + std::string(1, each.level) + std::to_string(each.timestamp) +
           std::string(each.text);
  }
  std::string operator()(const Dropout& each) const {
    return "O" + std::to_string(each.duration_ms);
  }
  template <typename Other>
  std::string operator()(const Other&) const {
    return "";  // formats, subscriptions and sync messages follow from the others
  }
};

// Writes a message of any type but F and A. Returns it as Flat gives it.
std::string write_arbitrary(Writer& writer, const std::vector<Topic>& topics) {
  const auto number = *rc::gen::resize(100, rc::gen::arbitrary<std::uint32_t>());
  switch (*rc::gen::inRange(0, 7)) {
    case 0: {
      const std::string text = arbitrary_bytes(1 + number % 9);
      RC_ASSERT(writer.info("info", text).has_value());
      return "Iinfochar" + text;
    }
    case 1: {
      const auto value = static_cast<std::int32_t>(number);
      RC_ASSERT(writer.parameter("INT", value).has_value());
      return "PINTint32_t" + std::string(reinterpret_cast<const char*>(&value), sizeof value);
    }
    case 2: {
      float value = 0;
      std::memcpy(&value, &number, sizeof value);
      RC_ASSERT(writer.parameter("REAL", value).has_value());
      return "PREALfloat" + std::string(reinterpret_cast<const char*>(&value), sizeof value);
    }
    case 3: {
      const std::string text = arbitrary_bytes(number % 9);
      RC_ASSERT(writer.log('5', number, text).has_value());
      return "L5" + std::to_string(number) + text;
    }
    case 4:
      RC_ASSERT(writer.dropout(static_cast<std::uint16_t>(number)).has_value());
      return "O" + std::to_string(static_cast<std::uint16_t>(number));
    default: {
      const std::size_t id = number % (2 * topics.size());  // as subscribed below
      const std::string bytes = arbitrary_bytes(topics[id / 2].bytes);
      RC_ASSERT(writer.data(static_cast<std::uint16_t>(id), bytes).has_value());
      return "D" + topics[id / 2].name + std::to_string(id % 2) + bytes;
    }
  }
}

RC_GTEST_PROP(ULogRoundTrip, KeepsEveryBit, ()) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "a.ulg";
  auto writer = Writer::open(path, 1);
  RC_ASSERT(writer.has_value());
  std::vector<Topic> topics;
  for (std::size_t i = *rc::gen::inRange<std::size_t>(1, 5); i > 0; --i) {
    topics.push_back(arbitrary_topic(i));
    RC_ASSERT(writer->define(topics.back().definition).has_value());
  }
  for (const Topic& topic : topics) {
    RC_ASSERT(writer->subscribe(topic.name, 0).has_value());
    RC_ASSERT(writer->subscribe(topic.name, 1).has_value());
  }
  std::vector<std::string> written;
  for (int i = *rc::gen::inRange(0, 40); i > 0; --i) {
    written.push_back(write_arbitrary(*writer, topics));
  }
  RC_ASSERT(writer->commit().has_value());

  auto reader = Reader::open(path);
  RC_ASSERT(reader.has_value());
  std::vector<std::string> read;
  Message message;
  while (reader->next(message).value()) {
    std::string flat = std::visit(Flat{}, message);
    if (!flat.empty()) read.push_back(std::move(flat));
  }
  RC_ASSERT(read == written);
  RC_ASSERT(reader->damage().total() == 0u);
}

}  // namespace
}  // namespace attest::ulog
