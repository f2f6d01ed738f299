#include "harness/ulog/writer.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace attest::ulog {
namespace {

constexpr std::size_t most_in_block = std::size_t{64} << 10;
constexpr std::string_view sync_message("\x08\x00S\x2F\x73\x13\x20\x25\x0C\xBB\x12", 11);

constexpr std::string_view topic_characters =
    "-/_0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::string_view field_characters = topic_characters.substr(2);

template <typename T>
std::string stored(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

Result<void> check_name(std::string_view name, std::string_view allowed = field_characters) {
  if (!name.empty() && name.find_first_not_of(allowed) == name.npos) return {};
  return fail(fmt::format("`{}` is not a name; use only {}", name, allowed));
}

Result<void> check_fields(const Format& format) {
  const Field& first = format.fields.front();
  if (first.name != "timestamp" || first.type != Type::u64 || first.is_array) {
    return fail(fmt::format("{}: the first field must be `uint64_t timestamp`", format.name));
  }
  std::uint32_t most_bytes = bytes_of(Type::u64);
  std::set<std::string> names;
  for (const Field& field : format.fields) {
    const auto wrong = [&](std::string_view why) {
      return fail(fmt::format("{}.{} {}", format.name, field.name, why));
    };
    if (auto checked = check_name(field.name); !checked) return checked;
    if (field.name.front() == '_') return wrong("starts with _, so readers skip it");
    if (!names.insert(field.name).second) return wrong("occurs twice");
    if (field.type == Type::nested) return wrong("has no basic type");
    const std::uint32_t bytes = bytes_of(field.type);
    if (bytes > most_bytes) return wrong("is larger than the field before it; sort by size");
    most_bytes = bytes;
  }
  return {};
}

}  // namespace

Writer::Writer(AtomicFile file, std::uint64_t start_us) : file_(std::move(file)) {
  block_ = std::string(file_magic) + '\x01' + stored(start_us);
  const std::string no_flags(40, '\0');
  block_ += stored(static_cast<std::uint16_t>(no_flags.size())) + 'B' + no_flags;
}

Result<Writer> Writer::open(const std::filesystem::path& path, std::uint64_t start_us) {
  return AtomicFile::open(path).map(
      [&](AtomicFile&& file) { return Writer(std::move(file), start_us); });
}

Result<void> Writer::write(char type, std::initializer_list<std::string_view> parts) {
  std::size_t size = 0;
  for (const std::string_view part : parts) size += part.size();
  if (size > 0xffff) return fail(fmt::format("a message of {} bytes; at most 65535 fit", size));
  block_ += stored(static_cast<std::uint16_t>(size)) + type;
  for (const std::string_view part : parts) block_ += part;
  if (block_.size() < most_in_block) return {};
  // Readers would take a sync message among the definitions for the start of the data.
  if (!subscribed_.empty()) block_ += sync_message;
  if (status_) status_ = file_.write(block_);
  block_.clear();
  return status_;
}

// `key`: "type name".
Result<void> Writer::write_value(char type, std::string_view key, std::string_view value) {
  if (auto checked = check_name(key.substr(key.find(' ') + 1)); !checked) return checked;
  if (key.size() > 0xff) return fail(fmt::format("`{}` is too long for a key", key));
  return write(type, {stored(static_cast<std::uint8_t>(key.size())), key, value});
}

Result<void> Writer::info(std::string_view name, std::string_view text) {
  if (text.empty()) return fail(fmt::format("{} has no text", name));
  return write_value('I', fmt::format("char[{}] {}", text.size(), name), text);
}

Result<void> Writer::parameter(std::string_view name, std::variant<std::int32_t, float> value) {
  const std::string key = fmt::format("{} {}", value.index() == 0 ? "int32_t" : "float", name);
  return write_value('P', key, std::visit([](auto each) { return stored(each); }, value));
}

Result<void> Writer::define(std::string_view definition) {
  if (!subscribed_.empty()) return fail("define all topics before the first subscription");
  Formats parsed;
  auto format = parsed.add(definition);
  if (!format) return tl::unexpected(format.error());
  const std::string& topic = (*format)->name;
  if (auto checked = check_name(topic, topic_characters); !checked) return checked;
  if (auto checked = check_fields(**format); !checked) return checked;
  format = parsed.measure(topic);
  if (!format) return tl::unexpected(format.error());
  if (formats_.all().contains(topic)) return fail(fmt::format("{} is defined twice", topic));
  if (auto written = write('F', {definition}); !written) return written;
  return formats_.add(definition).map([](const Format*) {});
}

Result<std::uint16_t> Writer::subscribe(std::string_view topic, std::uint8_t multi_id) {
  const auto format = formats_.measure(topic);
  if (!format) return tl::unexpected(format.error());
  if (subscribed_.size() > 0xffff) return fail("more than 65536 subscriptions");
  if (!instances_.emplace(topic, multi_id).second) {
    return fail(fmt::format("instance {} of {} is subscribed already", multi_id, topic));
  }
  const auto id = static_cast<std::uint16_t>(subscribed_.size());
  subscribed_.push_back(*format);
  return write('A', {stored(multi_id), stored(id), topic}).map([&] { return id; });
}

Result<void> Writer::data(std::uint16_t msg_id, std::string_view bytes) {
  if (msg_id >= subscribed_.size()) return fail(fmt::format("no msg_id {}; subscribe", msg_id));
  const Format& format = *subscribed_[msg_id];
  if (bytes.size() != format.bytes) {
    return fail(fmt::format("{} has {} bytes, not {}", format.name, format.bytes, bytes.size()));
  }
  return write('D', {stored(msg_id), bytes});
}

Result<void> Writer::log(char level, std::uint64_t timestamp_us, std::string_view text) {
  if (level < '0' || level > '7') return fail("the level of a log line is not from '0' to '7'");
  return write('L', {std::string_view(&level, 1), stored(timestamp_us), text});
}

Result<void> Writer::dropout(std::uint16_t duration_ms) {
  return write('O', {stored(duration_ms)});
}

Result<void> Writer::commit() {
  if (status_) status_ = file_.write(block_);
  return status_ ? file_.commit() : status_;
}

}  // namespace attest::ulog
