#include "harness/ulog/reader.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/printable.hpp"
#include "harness/core/suggestion.hpp"

namespace attest::ulog {
namespace {

using enum DamageKind;

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
constexpr std::uint64_t most_file_bytes = std::uint64_t{16} << 30;
constexpr std::string_view sync_magic = "\x2F\x73\x13\x20\x25\x0C\xBB\x12";
constexpr std::size_t header_bytes = 16;
constexpr std::size_t flag_bits_bytes = 40;
constexpr std::uint64_t has_appended_data = 1;  // bit of incompatible_flags

// The size, with its head, of the message that starts with these bytes, which may be cut off. 0 if
// they are not a message: all types are letters, no body is empty, and a known type has a least
// size of its body.
std::size_t size_of_message(std::string_view bytes) {
  constexpr std::string_view known = "BFIMPQARDLCOS";
  constexpr std::size_t least[] = {flag_bits_bytes, 1, 1, 2, 1, 2, 4, 2, 2, 9, 11, 2, 8};
  if (bytes.size() < head_bytes) return head_bytes;
  const std::size_t body_bytes = load<std::uint16_t>(bytes.data());
  const char type = bytes[2];
  const bool is_letter = (type >= 'A' && type <= 'Z') || (type >= 'a' && type <= 'z');
  const auto found = type == 'D' ? 8 : known.find(type);  // D, first because nearly all are
  return is_letter && body_bytes >= (found == known.npos ? 1 : least[found])
             ? head_bytes + body_bytes
             : 0;
}

bool is_text(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) {
    return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t';
  });
}

}  // namespace

Result<Reader> Reader::open(const std::filesystem::path& path) {
  const auto descriptor = open_regular_file(path);
  if (!descriptor) return tl::unexpected(descriptor.error());
  Reader reader;
  reader.file_ = path.string();
  reader.stream_.reset(::fdopen(*descriptor, "rb"));
  std::setvbuf(reader.stream_.get(), nullptr, _IONBF, 0);  // buffer_ is the buffer
  ::fseeko(reader.stream_.get(), 0, SEEK_END);
  reader.file_size_ = static_cast<std::uint64_t>(::ftello(reader.stream_.get()));
  if (reader.file_size_ > most_file_bytes) {
    return fail_at(reader.file_, fmt::format("is larger than {} GiB, the most that a log may have",
                                             most_file_bytes >> 30));
  }
  reader.buffer_.reset(new char[buffer_bytes]);
  if (auto read = reader.read_header(); !read) return tl::unexpected(read.error());
  reader.start();
  for (Message message = Sync{}; !std::holds_alternative<Data>(message);) {
    const auto more = reader.next(message);
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
  }
  reader.start();
  return reader;
}

// Also reads the flag bits, the first message of version 1. If they are damaged, they are not read
// here, and next() counts the damage.
Result<void> Reader::read_header() {
  first_message_ = header_bytes;
  end_ = file_size_;
  std::string_view bytes = bytes_at(0, header_bytes + head_bytes + flag_bits_bytes);
  if (read_failure_) return tl::unexpected(*read_failure_);
  if (bytes.empty()) return fail_at(file_, "is empty; copy the log again");
  if (bytes.substr(0, 7) != file_magic.substr(0, bytes.size())) {
    return fail_at(file_, fmt::format("{}not a ULog; name a .ulg file of PX4's logger",
                                      is_text(bytes) ? "is a text, and " : ""));
  }
  if (bytes.size() < header_bytes) return fail_at(file_, "is cut off; copy the log again");
  header_.version = load<std::uint8_t>(&bytes[7]);
  header_.start_us = load<std::uint64_t>(&bytes[8]);
  if (header_.version > 1) {
    return fail_at(file_,
                   fmt::format("a ULog of version {}; convert it to 1, or use a newer attest",
                               header_.version));
  }
  bytes.remove_prefix(header_bytes);
  if (bytes.size() < head_bytes + flag_bits_bytes || bytes[2] != 'B') return {};
  const std::size_t size = head_bytes + load<std::uint16_t>(bytes.data());
  if (size < head_bytes + flag_bits_bytes || header_bytes + size > file_size_) return {};
  first_message_ += size;
  header_.compatible_flags = load<std::uint64_t>(&bytes[head_bytes]);
  header_.incompatible_flags = load<std::uint64_t>(&bytes[head_bytes + 8]);
  header_.appended_offsets = load<std::array<std::uint64_t, 3>>(&bytes[head_bytes + 16]);
  if ((header_.incompatible_flags & ~has_appended_data) == 0) return {};
  return fail_at(file_, fmt::format("needs a feature that attest does not know (incompatible flags "
                                    "{:#x}); use a newer attest",
                                    header_.incompatible_flags));
}

// Goes to the first message. open() calls this again when it has read up to the first data.
void Reader::start() {
  damage_ = {};
  unknown_messages_ = 0;
  active_.clear();
  section_ends_.clear();
  offset_ = header_bytes;
  section_ = 0;
  std::uint64_t begin = first_message_;
  for (const std::uint64_t offset : header_.appended_offsets) {
    if ((header_.incompatible_flags & has_appended_data) == 0 || offset == 0) continue;
    if (offset >= begin && offset <= file_size_) {
      section_ends_.push_back(begin = offset);
    } else {
      refuse(bad_message, fmt::format("no appended data at byte {}", offset));
    }
  }
  section_ends_.push_back(file_size_);
  end_ = section_ends_.front();
  position_ = first_message_;
}

std::string_view Reader::bytes_at(std::uint64_t offset, std::size_t count) {
  if (offset < buffer_begin_ || offset + count > buffer_end_) fill_buffer(offset);
  const std::uint64_t end = std::max(std::min(buffer_end_, end_), offset);
  return {buffer_.get() + (offset - buffer_begin_), static_cast<std::size_t>(end - offset)};
}

void Reader::fill_buffer(std::uint64_t offset) {
  const bool overlaps = offset >= buffer_begin_ && offset < buffer_end_;
  const std::size_t kept = overlaps ? static_cast<std::size_t>(buffer_end_ - offset) : 0;
  std::memmove(buffer_.get(), &buffer_[buffer_end_ - buffer_begin_ - kept], kept);
  ::fseeko(stream_.get(), static_cast<off_t>(offset + kept), SEEK_SET);
  const std::size_t read = std::fread(&buffer_[kept], 1, buffer_bytes - kept, stream_.get());
  if (std::ferror(stream_.get()) != 0) {
    read_failure_ = Error{"cannot read: " + std::generic_category().message(errno), file_};
  }
  if (interrupted()) read_failure_ = Error{"not read to its end: interrupted", file_};
  buffer_begin_ = offset;
  buffer_end_ = offset + kept + read;
}

Result<bool> Reader::next_of_any_kind(Message& message) {
  while (true) {
    if (read_failure_) return tl::unexpected(*read_failure_);
    if (position_ >= end_) {
      if (section_ + 1 == section_ends_.size()) return false;
      position_ = end_;
      end_ = section_ends_[++section_];
      continue;
    }
    offset_ = position_;
    std::string_view bytes = bytes_at(offset_, head_bytes);
    const std::size_t size = size_of_message(bytes);
    if (bytes.size() < size) bytes = bytes_at(offset_, size);
    if (size == 0 || bytes.size() < size) {
      resynchronise(size > 0);
      continue;
    }
    position_ += size;
    if (accept(bytes[2], bytes.substr(head_bytes, size - head_bytes), message)) return true;
    if (size_of_message(bytes_at(position_, head_bytes)) == 0) resynchronise(false);
  }
}

bool Reader::accept(char type, std::string_view body, Message& message) {
  if (type == 'D') return accept_data(body, message);
  if (type == 'A') return accept_subscription(body, message);
  if (std::string_view("IMPQ").find(type) != body.npos) return accept_value(type, body, message);
  if (type == 'B') return refuse(bad_message, "flag bits that are not first");
  if (type == 'S' && body != sync_magic) return refuse(bad_message, "not a sync");
  if (type == 'F') {
    const auto format = formats_.add(body);
    if (!format) return refuse(bad_format, format.error().message);
    message = Defined{*format};
  } else if (type == 'R') {
    const std::size_t id = load<std::uint16_t>(body.data());
    const auto* const ended = id < active_.size() ? std::exchange(active_[id], nullptr) : nullptr;
    if (!ended) return refuse(unknown_id, fmt::format("no msg_id {} to end", id));
    message = Subscribed{ended, true};
  } else if (type == 'L' || type == 'C') {
    const std::size_t tag_bytes = type == 'C' ? sizeof(std::uint16_t) : 0;
    LogLine line{body[0], std::nullopt, load<std::uint64_t>(&body[1 + tag_bytes]),
                 body.substr(9 + tag_bytes)};
    if (tag_bytes > 0) line.tag = load<std::uint16_t>(&body[1]);
    message = line;
  } else if (type == 'O') {
    message = Dropout{load<std::uint16_t>(body.data())};
  } else if (type == 'S') {
    message = Sync{};
  } else {
    ++unknown_messages_;
    return false;
  }
  return true;
}

bool Reader::accept_data(std::string_view body, Message& message) {
  const std::size_t id = load<std::uint16_t>(body.data());
  const std::string_view bytes = body.substr(sizeof(std::uint16_t));
  const Subscription* const found = id < active_.size() ? active_[id] : nullptr;
  if (!found) return refuse(unknown_id, fmt::format("data of msg_id {}", id));
  const Format* const format = found->format;
  if (!format) return refuse(bad_format, "data without format: " + found->topic);
  if (!format->allows(bytes.size())) {
    return refuse(wrong_size, fmt::format("{} bytes of {}, which has {}", bytes.size(),
                                          format->name, format->bytes));
  }
  message = Data{found, bytes};
  return true;
}

// A body is: a byte of flags (M and Q only), u8 length of the key, key "type name", value.
bool Reader::accept_value(char type, std::string_view body, Message& message) {
  const bool is_parameter = type == 'P' || type == 'Q';
  std::uint8_t flags = 0;
  if (type == 'M' || type == 'Q') {
    flags = load<std::uint8_t>(body.data());
    body.remove_prefix(1);
  }
  const std::string_view key = body.substr(1, load<std::uint8_t>(body.data()));
  const std::string_view value = body.substr(1 + key.size());
  // A wrong length would lead to garbage, which counts as damage of its own. A data message does
  // not become one of these by a single wrong bit.
  const bool is_harmless = type != 'P';
  const auto field = parse_field(key);
  if (!field) return refuse(bad_message, "key " + field.error().message, is_harmless);
  const bool is_number = field->type == Type::i32 || field->type == Type::f32;
  if (field->type == Type::nested || (is_parameter && (!is_number || field->is_array)) ||
      value.size() != std::uint64_t{bytes_of(field->type)} * field->count) {
    return refuse(bad_message,
                  fmt::format("`{}` with {} bytes in a message {}", key, value.size(), type),
                  is_harmless);
  }
  const std::string_view name = key.substr(key.find(' ') + 1);
  message = KeyValue{type, flags, name, field->type, field->is_array, value};
  return true;
}

// The body is: u8 multi_id, u16 msg_id, topic.
bool Reader::accept_subscription(std::string_view body, Message& message) {
  Subscription added{load<std::uint16_t>(&body[1]), load<std::uint8_t>(body.data()),
                     std::string(body.substr(3)), subscriptions_.size(), nullptr};
  const auto known =
      std::find_if(subscriptions_.begin(), subscriptions_.end(), [&](const Subscription& each) {
        return each.id == added.id && each.multi_id == added.multi_id && each.topic == added.topic;
      });
  Subscription& subscription =
      known != subscriptions_.end() ? *known : subscriptions_.emplace_back(std::move(added));
  if (active_.size() <= subscription.id) active_.resize(std::size_t{subscription.id} + 1);
  active_[subscription.id] = &subscription;
  const auto format = formats_.measure(subscription.topic);
  if (!format) return refuse(bad_format, format.error().message);
  subscription.format = *format;
  if (const std::string name = (*format)->repeated_leaf(); !name.empty()) {
    refuse(bad_format, fmt::format("{} has the field {} more than once; the first one is used",
                                   subscription.topic, name));
  }
  message = Subscribed{&subscription, false};
  return true;
}

bool Reader::refuse(DamageKind kind, const std::string& why, bool is_harmless) {
  ++damage_.counts[static_cast<std::size_t>(kind)];
  if (is_harmless || is_appended()) ++damage_.harmless;
  if (damage_.first.size() < Damage::most_findings) {
    damage_.first.push_back({offset_, kind, printable_part(why)});
  }
  return false;
}

// Sets position_ after the first sync message from offset_ on; to the end of the section if there
// is none. `is_cut_off`: the message at offset_ leads past that end. It counts as cut off only if
// no sync message follows; otherwise its length was wrong (garbage).
void Reader::resynchronise(bool is_cut_off) {
  bool is_found = false;
  for (position_ = offset_; position_ < end_ && !is_found && !read_failure_;) {
    const std::string_view bytes = bytes_at(position_, sync_magic.size());
    if (bytes.size() < sync_magic.size()) break;
    const auto found = bytes.find(sync_magic);
    is_found = found != bytes.npos;
    position_ += is_found ? found + sync_magic.size() : bytes.size() - sync_magic.size() + 1;
  }
  if (!is_found) position_ = end_;
  damage_.skipped_bytes += position_ - offset_;
  refuse(is_cut_off && !is_found ? cut_off : garbage,
         fmt::format("not a whole message; {} bytes are skipped, {}", position_ - offset_,
                     is_found ? "up to a sync message" : "to the end, without a sync message"));
}

Reader::Place Reader::place_of_last() const {
  return {offset_, section_, active_, damage_, unknown_messages_};
}

void Reader::return_to(const Place& place) {
  position_ = place.position;
  section_ = place.section;
  end_ = section_ends_[section_];
  active_ = place.active;
  damage_ = place.damage;
  unknown_messages_ = place.unknown_messages;
}

Result<Column> Reader::find(std::string_view topic, std::uint8_t multi_id,
                            std::string_view path) const {
  std::vector<std::string> topics;
  for (const Subscription& each : subscriptions_) {
    if (each.topic != topic) topics.push_back(each.topic);
    if (each.topic != topic || each.multi_id != multi_id) continue;
    const auto leaf =
        each.format ? each.format->locate(path) : Result<Field>(fail("the format is damaged"));
    if (!leaf) return fail_at(file_, printable_part(leaf.error().message));
    return Column{&each, leaf->type, leaf->offset};
  }
  return fail_at(file_, printable_part(fmt::format("no instance {} of the topic {}{}", multi_id,
                                                   topic, suggestion(topic, topics))));
}

}  // namespace attest::ulog
