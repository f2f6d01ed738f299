// Text frames: one JSON object on each line. The signals have the names of channels.hpp.
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/port/conversation.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/csv_cells.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

using nlohmann::json;

// The names of the results. The index of a name is the result's number in attest_unit.h.
constexpr std::array<std::string_view, 4> results{"ok", "unsupported", "invalid", "failed"};

// The members of a StepCost.
constexpr std::array<const char*, 2> cost_members{"cost", "stack"};

json to_json(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

std::optional<double> number_from(const json& value) {
  if (value.is_number()) return value.get<double>();
  if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
  if (value == "nan") return std::nan("");
  if (value == "inf") return HUGE_VAL;
  if (value == "-inf") return -HUGE_VAL;
  return std::nullopt;
}

bool is_possible(const Channel& channel, double value) {
  if (channel.type == ChannelType::f32) return true;
  return value >= 0 && value <= 255 && value == std::floor(value);
}

class TextConversation final : public Conversation {
 public:
  TextConversation(PipedProgram program, Hello hello)
      : Conversation(std::move(program), std::move(hello)),
        line_end_(this->hello().byte_after_line ? "\n " : "\n") {
    // The byte after the greeting, now that it is known to be harmless. If it cannot be written,
    // the first request says so.
    if (this->hello().byte_after_line) this->program().write(" ");
  }

  int create(std::uint32_t unit, Module module, const std::string& profile,
             const std::string& definition) override {
    json request = {{"module", name_of(module)}, {"profile", profile}};
    if (!definition.empty()) request["definition"] = definition;
    return result_of(Request::create, unit, std::move(request));
  }

  int destroy(std::uint32_t unit) override { return result_of(Request::destroy, unit, {}); }

  int set_parameter(std::uint32_t unit, const std::string& name, float value) override {
    return result_of(Request::set_parameter, unit, {{"name", name}, {"value", to_json(value)}});
  }

  int step(std::uint32_t unit, Module module, ProgramStep& step) override {
    json request = {{"timestamp_sample", step.timestamp_sample_us},
                    {"timestamp", step.sample.in.timestamp}};
    for_each_channel(module, "in/", [&](const Channel& channel) {
      json& member = request[std::string(channel.name)];
      if (channel.type == ChannelType::u64) {
        member = integer_of(channel, step.sample);
      } else {
        member = to_json(value_of(channel, step.sample));
      }
    });
    const json answer = exchange(Request::step, unit, std::move(request));
    // A topic whose flag `published` is not in the answer is not published.
    clear_published(module, step.sample);
    std::size_t read = 0;
    for_each_channel(module, "out/", [&](const Channel& channel) {
      read += take_output(answer, channel, step.sample) ? 1 : 0;
    });
    const int result = number_of(Request::step, answer);
    if (hello().cost && result == ATTEST_OK) step.cost = cost_in(answer);
    for (const char* name : cost_members) read += hello().cost && answer.contains(name) ? 1 : 0;
    if (answer.size() != read + 2) refuse_unknown(answer, module);
    return result;
  }

 private:
  template <typename Use>
  static void for_each_channel(Module module, std::string_view prefix, Use use) {
    const ChannelSet set = channels_of(module, prefix);
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (set[i] && channels()[i].name != "timestamp") use(channels()[i]);
    }
  }

  bool take_output(const json& answer, const Channel& channel, Sample& sample) {
    const auto found = answer.find(channel.name);
    if (found == answer.end()) return false;
    const auto value = number_from(*found);
    if (!value || !is_possible(channel, *value)) {
      broken(Request::step, fmt::format("has `{}` = {}, which is no value of that signal",
                                        channel.name, text_of(*found)));
    }
    set_value(channel, sample, *value);
    return true;
  }

  StepCost cost_in(const json& answer) {
    const auto take = [&](const char* name) {
      const auto found = answer.find(name);
      if (found == answer.end()) {
        broken(Request::step, fmt::format("lacks `{}`, although the handshake has `cost`", name));
      }
      const bool is_count = found->is_number_unsigned() && *found <= UINT32_MAX;
      if (!is_count) {
        broken(Request::step, fmt::format("has `{}` = {}; it is an integer from 0 to {}", name,
                                          text_of(*found), UINT32_MAX));
      }
      return found->get<std::uint32_t>();
    };
    return {take(cost_members[0]), take(cost_members[1])};
  }

  [[noreturn]] void refuse_unknown(const json& answer, Module module) {
    for (const auto& [name, value] : answer.items()) {
      const auto known = find_channel(module, name);
      const bool is_output = known && channels()[*known].is_output();
      if (name == "result" || name == "sequence" || is_output) continue;
      if (hello().cost && (name == cost_members[0] || name == cost_members[1])) continue;
      broken(Request::step, fmt::format("has `{}`, which is no output of that module", name));
    }
    broken(Request::step, "has members that were not asked for");
  }

  int result_of(Request kind, std::uint32_t unit, json request) {
    return number_of(kind, exchange(kind, unit, std::move(request)));
  }

  json exchange(Request kind, std::uint32_t unit, json request) {
    const std::uint32_t sequence = next_sequence();
    request["do"] = name_of(kind);
    request["unit"] = unit;
    request["sequence"] = sequence;
    if (!program().write(text_of(request) + line_end_)) ended(kind);
    const auto line = program().read_line(max_line);
    if (!line && program().unread().size() > max_line) {
      broken(kind, fmt::format("has no end within {} bytes", max_line));
    }
    if (!line) ended(kind);
    auto parsed = parse_json(*line, "");
    json answer = parsed ? *std::move(parsed) : json_from(*line);
    if (!answer.is_object() || !answer.contains("sequence") || !answer.contains("result")) {
      broken(kind, fmt::format("is {}; it must be a JSON object with `sequence` and `result`",
                               in_backquotes(*line)));
    }
    if (!parsed) broken(kind, parsed.error().message);
    if (answer["sequence"] != sequence) {
      broken(kind, fmt::format("has the sequence number {}; that of the request is {}",
                               text_of(answer["sequence"]), sequence));
    }
    return answer;
  }

  int number_of(Request kind, const json& answer) {
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (answer["result"] == results[i]) return static_cast<int>(i);
    }
    broken(kind, fmt::format("has the result {}; it is `ok`, `unsupported`, `invalid` or `failed`",
                             text_of(answer["result"])));
  }

  const std::string line_end_;  // of requests; its space is before the JSON of the next line
};

}  // namespace

std::unique_ptr<Conversation> text_conversation(PipedProgram program, Hello hello) {
  return std::make_unique<TextConversation>(std::move(program), std::move(hello));
}

}  // namespace attest
