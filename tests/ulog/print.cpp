// Prints all that attest's reader reads of a ULog, a JSON object a line, as foxglove.mjs does.
//
//     attest_ulog_print FILE
// Damage goes to stderr, and the exit code is then 1.
#include <cmath>
#include <iostream>
#include <map>

#include <nlohmann/json.hpp>

#include "harness/ulog/reader.hpp"

namespace attest::ulog {
namespace {

using nlohmann::json;

// What JSON has no number for becomes text.
json number(Type type, const char* bytes) {
  if (type == Type::u64) return std::to_string(load<std::uint64_t>(bytes));
  if (type == Type::i64) return std::to_string(load<std::int64_t>(bytes));
  if (type == Type::boolean) return load_as<bool>(type, bytes);
  const auto value = load_as<double>(type, bytes);
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  if (value == 0 && std::signbit(value)) return "-0";
  return value;
}

json value_of(Type type, bool is_array, std::string_view bytes) {
  if (type == Type::character) return std::string(bytes);
  if (!is_array) return number(type, bytes.data());
  json list = json::array();
  for (std::size_t at = 0; at < bytes.size(); at += bytes_of(type)) {
    list.push_back(number(type, bytes.data() + at));
  }
  return list;
}

class Printer {
 public:
  void operator()(const Data& data) {
    is_definition_ = false;
    json fields = json::object();
    for (const Field& leaf : data.subscription->format->leaves) {
      const auto bytes = data.bytes.substr(leaf.offset, leaf.count * bytes_of(leaf.type));
      fields[leaf.name] = value_of(leaf.type, leaf.is_array, bytes);
    }
    const Subscription& subscription = *data.subscription;
    print({{"data", subscription.topic}, {"multi_id", subscription.multi_id}, {"fields", fields}});
  }

  // foxglove.mjs has the definitions at the start only, the last one of each name.
  void operator()(const Defined& defined) {
    json fields = json::array();
    for (const Field& field : defined.format->fields) {
      fields.push_back({field.type_name, field.is_array ? field.count : 0, field.name});
    }
    print({{"format", defined.format->name}, {"fields", fields}});
  }

  void operator()(const Subscribed& each) {
    is_definition_ = false;
    const Subscription& subscription = *each.subscription;
    if (each.has_ended) return print({{"end", subscription.id}});
    print({{"subscribe", subscription.id},
           {"multi_id", subscription.multi_id},
           {"topic", subscription.topic}});
  }

  void operator()(const KeyValue& each) {
    const json value = value_of(each.type, each.is_array, each.bytes);
    const std::string brackets =
        each.is_array ? "[" + std::to_string(each.bytes.size() / bytes_of(each.type)) + "]" : "";
    const std::string name(each.name);
    const std::string key = std::string(name_of(each.type)) + brackets + " " + name;
    if (!is_definition_) {
      print({{"later", std::string(1, each.kind)}, {"key", key}, {"value", value}});
    } else if (each.kind == 'I') {
      definitions_["I " + name] = {{"info", name}, {"value", value}};
    } else if (each.kind == 'M') {
      json& multi = definitions_["M " + key];
      multi["multi"] = key;
      multi["values"].push_back(value);
    } else {
      // foxglove.mjs has defaults in place of the value.
      definitions_["P " + name] = {{"parameter", name}, {"value", value}, {"defaults", each.flags}};
    }
  }

  void operator()(const LogLine& line) {
    is_definition_ = false;
    print({{"level", static_cast<int>(line.level)},
           {"tag", line.tag ? int{*line.tag} : -1},
           {"timestamp", std::to_string(line.timestamp)},
           {"text", std::string(line.text)}});
  }

  void operator()(const Dropout& dropout) {
    is_definition_ = false;
    print({{"dropout_ms", dropout.duration_ms}});
  }

  void operator()(const Sync&) {
    is_definition_ = false;
    print({{"sync", true}});
  }

  void print_definitions() const {
    for (const auto& [name, definition] : definitions_) print(definition);
  }

  static void print(const json& object) {
    std::cout << object.dump(-1, ' ', false, json::error_handler_t::replace) << '\n';
  }

 private:
  bool is_definition_ = true;  // before the first subscription, data, log line, dropout or sync
  std::map<std::string, json> definitions_;
};

int print_log(const char* path) {
  auto reader = Reader::open(path);
  if (!reader) {
    std::cerr << reader.error().to_string() << '\n';
    return 2;
  }
  const Header& header = reader->header();
  Printer::print({{"version", header.version}, {"start_us", std::to_string(header.start_us)}});
  Printer printer;
  Message message;
  for (auto more = reader->next(message); more.value(); more = reader->next(message)) {
    std::visit(printer, message);
  }
  printer.print_definitions();
  for (const Damage::Finding& finding : reader->damage().first) {
    std::cerr << "byte " << finding.offset << ": " << finding.message << '\n';
  }
  return reader->damage().total() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace attest::ulog

int main(int argc, char** argv) {
  if (argc == 2) return attest::ulog::print_log(argv[1]);
  std::cerr << "usage: attest_ulog_print FILE\n";
  return 2;
}
