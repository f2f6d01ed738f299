#include "tests/harness/ulog/log_file.hpp"

#include <fmt/format.h>

namespace attest::ulog {
namespace {

std::string value_text(Type type, bool is_array, std::string_view bytes) {
  if (type == Type::character && is_array) return std::string(bytes);
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += bytes_of(type)) {
    text += fmt::format("{}{}", at == 0 ? "" : ",", load_as<double>(type, bytes.data() + at));
  }
  return text;
}

std::string name_text(const Subscription& subscription) {
  return fmt::format("{}/{}", subscription.topic, subscription.multi_id);
}

struct Line {
  std::string operator()(const Data& data) const {
    std::string text = "D " + name_text(*data.subscription);
    for (const Field& leaf : data.subscription->format->leaves) {
      const auto bytes = data.bytes.substr(leaf.offset, leaf.count * bytes_of(leaf.type));
      text += fmt::format(" {}={}", leaf.name, value_text(leaf.type, leaf.is_array, bytes));
    }
    return text;
  }
  std::string operator()(const Defined& defined) const { return "F " + defined.format->name; }
  std::string operator()(const Subscribed& each) const {
    return (each.has_ended ? "R " : "A ") + name_text(*each.subscription);
  }
  std::string operator()(const KeyValue& each) const {
    const std::string flags = each.flags == 0 ? "" : fmt::format("{} ", each.flags);
    return fmt::format("{} {}{}={}", each.kind, flags, each.name,
                       value_text(each.type, each.is_array, each.bytes));
  }
  std::string operator()(const LogLine& line) const {
    const std::string tag = line.tag ? fmt::format(" tag {}", *line.tag) : "";
    return fmt::format("L {}{} {}: {}", line.level, tag, line.timestamp, line.text);
  }
  std::string operator()(const Dropout& dropout) const {
    return fmt::format("O {} ms", dropout.duration_ms);
  }
  std::string operator()(const Sync&) const { return "S"; }
};

}  // namespace

std::string line_of(const Message& message) { return std::visit(Line{}, message); }

LogLines lines_of(Reader& reader) {
  LogLines read;
  Message message;
  for (auto more = reader.next(message); more.value(); more = reader.next(message)) {
    read.lines.push_back(line_of(message));
  }
  read.damage = reader.damage();
  read.unknown_messages = reader.unknown_messages();
  return read;
}

Reader LogFile::open(const Crafted& log) { return Reader::open(write(log)).value(); }

LogLines LogFile::read(const Crafted& log) {
  Reader reader = open(log);
  return lines_of(reader);
}

std::string LogFile::error_of(const Crafted& log) {
  const auto reader = Reader::open(write(log));
  if (reader) return "";
  return reader.error().to_string().substr(directory_.path().string().size() + 1);
}

}  // namespace attest::ulog
