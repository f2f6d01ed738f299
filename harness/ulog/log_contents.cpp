#include "harness/ulog/log_contents.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/printable.hpp"

namespace attest::ulog {
namespace {

std::string text_of(const KeyValue& value) {
  const auto end = std::min(value.bytes.find('\0'), value.bytes.size());
  return std::string(printable_part(value.bytes.substr(0, end)));
}

// For example 0x010e03ff: a byte each for major, minor and patch, then the kind of release.
Release release_of(std::uint32_t version) {
  const auto byte = [&](int shift) { return static_cast<int>(version >> shift & 0xffU); };
  return {byte(24), byte(16), byte(8)};
}

class ContentsReader {
 public:
  explicit ContentsReader(Reader& reader) : reader_(reader) {
    for (const ModuleInfo& info : modules()) {
      if (info.is_unit()) log_.modules.emplace_back(info.module);
    }
  }

  Result<LogContents> read() {
    Message message;
    while (true) {
      const auto more = reader_.next(message);
      if (!more) return tl::unexpected(more.error());
      if (!*more) break;
      if (reader_.is_appended()) continue;
      if (const auto* data = std::get_if<Data>(&message)) add(*data);
      if (const auto* value = std::get_if<KeyValue>(&message)) add(*value);
      if (std::holds_alternative<Dropout>(message)) ++log_.dropouts;
    }
    locate_empty_topics();
    add_damage();
    return std::move(log_);
  }

 private:
  void add(const KeyValue& value) {
    if (value.kind == 'P') {
      const auto number = load_as<float>(value.type, value.bytes.data());
      for (ModuleContents& module : log_.modules) {
        module.parameters.push_back({module.steps().size(), std::string(value.name), number});
      }
    } else if (value.kind == 'I' && value.type == Type::character) {
      if (value.name == "sys_name") log_.system = text_of(value);
      if (value.name == "ver_sw") log_.firmware = text_of(value);
      if (value.name == "attest_source") log_.source = text_of(value);
    } else if (value.kind == 'I' && value.name == "ver_sw_release" && value.type == Type::u32) {
      log_.release = release_of(load_as<std::uint32_t>(value.type, value.bytes.data()));
    }
  }

  // A topic may belong to several modules, as an input of one and an output of another.
  void add(const Data& data) {
    const std::size_t index = data.subscription->index;
    if (index >= receivers_.size()) receivers_.resize(index + 1);
    if (!receivers_[index]) receivers_[index] = receivers_of(*data.subscription);
    for (LogSeries* series : *receivers_[index]) series->add(reader_, data);
  }

  // At the first call the name of the system is known, because it comes before the first data.
  std::vector<LogSeries*> receivers_of(const Subscription& subscription) {
    if (!knows_system_) {
      knows_system_ = true;
      if (!log_.is_of_attest()) accept_every_publisher();
    }
    std::vector<LogSeries*> found;
    for (ModuleContents& module : log_.modules) {
      for (LogSeries& series : module.series()) {
        if (series.accepts(subscription)) found.push_back(&series);
      }
    }
    return found;
  }

  // The controller of v1.5.5 and v1.3.4 is left out: in its logs, too, other modules publish the
  // instance 1 of a setpoint.
  void accept_every_publisher() {
    for (ModuleContents& module : log_.modules) {
      if (!info_of(module.module()).is_of_cascade()) continue;
      for (LogSeries& series : module.series()) series.accept_every_publisher();
    }
  }

  void locate_empty_topics() {
    for (const Subscription& subscription : reader_.subscriptions()) {
      if (subscription.format == nullptr) continue;
      for (LogSeries* series : receivers_of(subscription)) {
        if (!series->is_located()) series->locate(reader_, subscription);
      }
    }
  }

  void add_damage() {
    const Damage& damage = reader_.damage();
    for (const auto& finding : damage.first) {
      log_.damage.push_back(fmt::format("byte {}: {}", finding.offset, finding.message));
    }
    if (damage.total() > damage.first.size()) {
      log_.damage.push_back(fmt::format("and {} more", damage.total() - damage.first.size()));
    }
  }

  Reader& reader_;
  LogContents log_;
  bool knows_system_ = false;
  std::vector<std::optional<std::vector<LogSeries*>>> receivers_;  // by subscription
};

}  // namespace

std::string Release::to_string() const { return fmt::format("v{}.{}.{}", major, minor, patch); }

ModuleContents::ModuleContents(Module module)
    : module_(module), step_topic_(info_of(module).step_topic) {
  for (LogTopic& topic : log_topics(module)) series_.emplace_back(std::move(topic));
}

bool ModuleContents::has_outputs() const {
  return std::any_of(series_.begin(), series_.end(), [](const LogSeries& series) {
    return series.is_output() && series.size() > 0 && !series.logged_channels().empty();
  });
}

const LogSeries* ModuleContents::find(std::string_view topic, bool is_output) const {
  const auto found = std::find_if(series_.begin(), series_.end(), [&](const LogSeries& one) {
    return one.name() == topic && one.is_output() == is_output;
  });
  return found == series_.end() ? nullptr : &*found;
}

ModuleContents& LogContents::of(Module module) {
  return *std::find_if(modules.begin(), modules.end(),
                       [&](const ModuleContents& one) { return one.module() == module; });
}

Result<LogContents> read_contents(const std::filesystem::path& path) {
  auto reader = Reader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  return ContentsReader(*reader).read();
}

}  // namespace attest::ulog
