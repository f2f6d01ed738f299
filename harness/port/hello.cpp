#include "harness/port/hello.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/version.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/csv_cells.hpp"

namespace attest {
namespace {

using nlohmann::json;

// Reads the members of the answer one by one. The first error is kept.
class Members {
 public:
  explicit Members(const json& object) : object_(object) {}

  template <typename T>
  T required(const char* name, const char* what) {
    if (!object_.contains(name)) {
      set_error(fmt::format("lacks `{}`, which is {}", name, what));
    }
    return optional<T>(name, what);
  }

  // Returns T() if the member is missing or of another type.
  template <typename T>
  T optional(const char* name, const char* what) {
    known_.emplace_back(name);
    if (!object_.contains(name)) return {};
    try {
      return object_.at(name).get<T>();
    } catch (const json::exception&) {
      set_error(fmt::format("has `{}` = {}; it is {}", name, text_of(object_.at(name)), what));
      return {};
    }
  }

  bool has(const char* name) const { return object_.contains(name); }

  // As optional(), but true and false are no numbers.
  double number(const char* name, const char* what) {
    if (has(name) && !object_.at(name).is_number()) {
      set_error(fmt::format("has `{}` = {}; it is {}", name, text_of(object_.at(name)), what));
    }
    return optional<double>(name, what);
  }

  void set_error(std::string error) {
    if (error_.empty()) error_ = std::move(error);
  }

  // The first error, or an unknown member. Empty if there is neither.
  std::string error() const {
    if (!error_.empty()) return error_;
    for (const auto& [name, value] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      return fmt::format("has the unknown member `{}`{}", name, suggestion(name, known_));
    }
    return "";
  }

 private:
  const json& object_;
  std::vector<std::string> known_;
  std::string error_;
};

void read_protocol(Members& members) {
  const char* const what = "the version of the protocol, a number";
  const json spoken = members.required<json>("protocol", what);
  if (!spoken.is_number_integer()) {
    members.set_error(fmt::format("has `protocol` = {}; it is {}", text_of(spoken), what));
  } else if (spoken != protocol_version) {
    members.set_error(
        fmt::format("has `protocol` {}; this attest speaks {}", text_of(spoken), protocol_version));
  }
}

// The modules that a program may have in addition to the controller.
std::vector<std::string> further_modules() {
  std::vector<std::string> names;
  for (const ModuleInfo& info : modules()) {
    if (info.extension != nullptr) names.emplace_back(info.name);
  }
  return names;
}

// A profile that attest does not know counts as one of the controller.
bool is_of_controller(const std::string& name) {
  const ProfileInfo* const profile = find_profile(name);
  return !profile || contains(profile->modules, Module::mc_att_control);
}

void read_modules(Members& members, Hello& hello) {
  if (std::any_of(hello.profiles.begin(), hello.profiles.end(), is_of_controller)) {
    hello.modules = only(Module::mc_att_control);
  }
  const std::string what = fmt::format("a list of `{}`", fmt::join(further_modules(), "`, `"));
  for (const auto& name : members.optional<std::vector<std::string>>("modules", what.c_str())) {
    const auto module = module_named(name);
    if (module && info_of(*module).extension != nullptr) {
      hello.modules |= only(*module);
    } else {
      members.set_error(fmt::format("has the module `{}`; `modules` is {}", name, what));
    }
  }
}

void read_frames(Members& members, Hello& hello) {
  const char* const what = "`binary`, `text` or `shared`";
  const auto frames = members.required<std::string>("frames", what);
  if (frames == "text") {
    hello.frames = FrameForm::text;
  } else if (frames == "shared") {
    hello.frames = FrameForm::shared;
  } else if (frames != "binary") {
    members.set_error(fmt::format("has `frames` = `{}`; it is {}", frames, what));
  }
  hello.has_batch = members.optional<bool>("batch", "true or false");
  if (hello.has_batch && hello.frames == FrameForm::text) {
    members.set_error("has `batch`, which text frames do not have");
  }
  hello.byte_after_line = members.optional<bool>("byte_after_line", "true or false");
  if (hello.byte_after_line && hello.frames != FrameForm::text) {
    members.set_error("has `byte_after_line`, which is for text frames only");
  }
}

void read_numbers(Members& members, Hello& hello) {
  const auto arithmetic = members.optional<std::string>("arithmetic", "text such as `fixed:22`");
  if (!arithmetic.empty()) {
    if (const auto bits = parse_fraction_bits(arithmetic)) {
      hello.fraction_bits = *bits;
    } else {
      members.set_error("is wrong: " + bits.error().message);
    }
  }
  const auto step = members.optional<std::string>("fixed_step", "a rate in Hz as text");
  if (!step.empty()) {
    if (const auto rate = Rate::parse(step)) {
      hello.fixed_step = *rate;
    } else {
      members.set_error("is wrong: its fixed step: " + rate.error().message);
    }
  }
}

void read_cost(Members& members, Hello& hello) {
  if (!members.has("cost")) return;
  const char* const what = "an object with `unit` and, for cycles, `clock_hz`";
  const json given = members.required<json>("cost", what);
  if (!given.is_object()) {
    return members.set_error(fmt::format("has `cost` = {}; it is {}", text_of(given), what));
  }
  Members of_cost(given);
  const auto unit = of_cost.required<std::string>("unit", "the unit in which it counts");
  std::optional<double> clock_hz;
  if (of_cost.has("clock_hz")) clock_hz = of_cost.number("clock_hz", "a number");
  const auto counter = CostCounter::make(unit, clock_hz);
  if (const std::string error = of_cost.error(); !error.empty()) {
    members.set_error("is wrong: its `cost` " + error);
  } else if (!counter) {
    members.set_error("is wrong: " + counter.error().message);
  } else {
    hello.cost = *counter;
  }
}

}  // namespace

std::string wrong_in_files(const std::vector<std::string>& names) {
  constexpr std::size_t most_files = 1000, most_bytes = 4096;
  if (names.size() > most_files) {
    return fmt::format("`files` has {} names; at most {} are possible", names.size(), most_files);
  }
  for (const std::string& name : names) {
    if (name.empty()) return "`files` has an empty name; each is the path of a file";
    if (name.size() >= most_bytes || name.find('\0') != std::string::npos) {
      return fmt::format("`files` has {}, which cannot be the path of a file", in_backquotes(name));
    }
  }
  return "";
}

std::string greeting() {
  return text_of({{"attest", version}, {"protocol", protocol_version}}) + '\n';
}

Result<Hello> parse_hello(std::string_view line) {
  const auto parsed = parse_json(line, "");
  const json object = parsed ? *parsed : json_from(line);
  if (!object.is_object()) {
    return fail(
        fmt::format("its first line on stdout is {}, which is no JSON object; only the "
                    "handshake belongs there, and text for people on stderr",
                    in_backquotes(line)));
  }
  if (!parsed) return fail("its answer to the handshake " + parsed.error().message);
  Members members(object);
  Hello hello;
  read_protocol(members);
  hello.name = members.required<std::string>("name", "the name of the port");
  hello.version = members.required<std::string>("version", "the version of the port, as text");
  hello.profiles = members.required<std::vector<std::string>>(
      "profiles", "a list of profiles such as `px4-v1.5.5`");
  read_frames(members, hello);
  read_modules(members, hello);
  hello.unsupported_groups =
      members.optional<std::vector<std::string>>("unsupported_groups", "a list of groups");
  const auto lacks = Lacks::parse(members.optional<std::vector<std::string>>(
      "lacks", "a list of features, outputs and constant parameters"));
  if (lacks) hello.lacks = *lacks;
  if (!lacks) members.set_error("is wrong: `lacks`: " + lacks.error().message);
  read_numbers(members, hello);
  read_cost(members, hello);
  hello.files = members.optional<std::vector<std::string>>(
      "files", "a list of the paths of further files of the port");
  for (const std::string& wrong :
       {wrong_in_declared(hello.name, hello.version, hello.unsupported_groups),
        wrong_in_files(hello.files)}) {
    if (!wrong.empty()) members.set_error("is wrong: " + wrong);
  }
  if (const std::string error = members.error(); !error.empty()) {
    return fail("its answer to the handshake " + error);
  }
  return hello;
}

}  // namespace attest
