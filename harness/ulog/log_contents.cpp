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

// For example 0x010e03ff: a byte each for major, minor and patch, then the type.
Release release_of(std::uint32_t version) {
  const auto byte = [&](int shift) { return static_cast<int>(version >> shift & 0xffU); };
  return {byte(24), byte(16), byte(8), byte(0)};
}

// A series that takes the samples of a subscription.
struct Receiver {
  ModuleContents* module;
  LogSeries* series;
};

// By subscription; empty: not yet known.
template <typename Receiver>
using Receivers = std::vector<std::optional<std::vector<Receiver>>>;

// Passes over data of topics without a receiver. Their times count nevertheless.
template <typename Receiver>
void skip_unread(const Receivers<Receiver>& receivers, TimeCheck& times, Reader& reader) {
  if (reader.is_appended()) return;
  reader.skip_data([&](const Data& data) {
    const std::size_t index = data.subscription->index;
    const bool is_unread =
        index < receivers.size() && receivers[index] && receivers[index]->empty();
    return is_unread && times.fits_at_once(data);
  });
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
      skip_unread(receivers_, times_, reader_);
      const auto more = reader_.next(message);
      if (!more) return tl::unexpected(more.error());
      if (!*more) break;
      if (reader_.is_appended()) continue;
      if (std::holds_alternative<Data>(message)) {
        const auto fit = times_.check(reader_, message);
        if (!fit) return tl::unexpected(fit.error());
        log_.has_data = true;
        add(std::get<Data>(message), *fit);
      }
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
      if (value.name == "ver_sw_branch") log_.branch = text_of(value);
      if (value.name == "attest_source") log_.source = text_of(value);
    } else if (value.kind == 'I' && value.name == "ver_sw_release" && value.type == Type::u32) {
      log_.release = release_of(load_as<std::uint32_t>(value.type, value.bytes.data()));
    }
  }

  // A topic may belong to several modules, as an input of one and an output of another.
  void add(const Data& data, TimeFit fit) {
    const std::size_t index = data.subscription->index;
    if (index >= receivers_.size()) receivers_.resize(index + 1);
    if (!receivers_[index]) receivers_[index] = receivers_of(*data.subscription);
    for (const Receiver& one : *receivers_[index]) {
      one.module->count(*one.series, reader_, data, fit);
    }
  }

  // At the first call the name of the system is known, because it comes before the first data.
  std::vector<Receiver> receivers_of(const Subscription& subscription) {
    if (!knows_system_) {
      knows_system_ = true;
      if (!log_.is_of_attest()) accept_every_publisher();
    }
    std::vector<Receiver> found;
    for (ModuleContents& module : log_.modules) {
      for (LogSeries& series : module.series()) {
        if (series.accepts(subscription)) found.push_back({&module, &series});
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
      for (const Receiver& one : receivers_of(subscription)) {
        if (!one.series->is_located()) one.series->locate(reader_, subscription);
      }
    }
  }

  void add_damage() {
    const Damage& damage = reader_.damage();
    log_.may_lack_samples = damage.may_lack_samples();
    for (const auto& finding : damage.first) {
      log_.damage.push_back(fmt::format("byte {}: {}", finding.offset, finding.message));
    }
    if (damage.total() > damage.first.size()) {
      log_.damage.push_back(fmt::format("and {} more", damage.total() - damage.first.size()));
    }
  }

  Reader& reader_;
  TimeCheck times_;
  LogContents log_;
  bool knows_system_ = false;
  Receivers<Receiver> receivers_;
};

}  // namespace

std::string_view Release::kind() const {
  constexpr std::string_view kinds[] = {"dev", "alpha", "beta", "rc"};
  return is_final() ? "release" : kinds[type / 64];
}

std::string Release::to_string() const {
  return fmt::format("v{}.{}.{}{}{}", major, minor, patch, is_final() ? "" : "-",
                     is_final() ? "" : kind());
}

ModuleContents::ModuleContents(Module module) : module_(module) {
  for (LogTopic& topic : log_topics(module)) series_.emplace_back(std::move(topic));
  while (series_[steps_].is_output() || series_[steps_].name() != info_of(module).step_topic) {
    ++steps_;
  }
}

bool ModuleContents::has_outputs() const {
  return std::any_of(series_.begin(), series_.end(), [](const LogSeries& series) {
    return series.is_output() && series.size() > 0 && !series.logged_channels().empty();
  });
}

void ModuleContents::count(LogSeries& series, const Reader& reader, const Data& data, TimeFit fit) {
  if (!takes(series, fit)) return series.leave_out_absurd();
  if (!series.count(reader, data)) return;
  const std::uint64_t time = series.newest_time();
  if (&series == &steps()) {
    if (series.size() == 1) first_step_us_ = time;
    gap_counts_.add(time);
  } else if (steps().size() > 0 && time <= first_step_us_) {
    order_.first_step_until = reader.offset();
  } else if (time < steps().newest_time()) {
    order_.latest_us = std::max(order_.latest_us, steps().newest_time() - time);
  }
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

Result<SampleReader> SampleReader::open(const std::string& path, ModuleContents& log) {
  auto reader = Reader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  for (LogSeries& series : log.series()) series.restart();
  return SampleReader(*std::move(reader), log);
}

Result<void> SampleReader::read_until(std::uint64_t time_us) {
  while (!has_ended_ && !has_all(time_us)) {
    if (auto read = read_message(); !read) return read;
  }
  return {};
}

Result<bool> SampleReader::read_more() {
  constexpr int messages = 1000;
  for (int i = 0; i < messages && !has_ended_; ++i) {
    if (auto read = read_message(); !read) return tl::unexpected(read.error());
  }
  return !has_ended_;
}

// See SampleOrder: the samples that follow in the file are later than `time_us`.
bool SampleReader::has_all(std::uint64_t time_us) const {
  const SampleOrder& order = log_->order();
  const std::uint64_t newest = log_->steps().newest_time();
  return reader_.offset() >= order.first_step_until && newest > time_us &&
         newest - time_us > order.latest_us;
}

Result<void> SampleReader::read_message() {
  skip_unread(receivers_, times_, reader_);
  Message message;
  const auto more = reader_.next(message);
  if (!more) return tl::unexpected(more.error());
  has_ended_ = !*more;
  if (has_ended_ || !std::holds_alternative<Data>(message) || reader_.is_appended()) return {};
  const auto fit = times_.check(reader_, message);
  if (!fit) return tl::unexpected(fit.error());
  const Data& data = std::get<Data>(message);
  const std::size_t index = data.subscription->index;
  if (index >= receivers_.size()) receivers_.resize(index + 1);
  if (!receivers_[index]) {
    receivers_[index].emplace();
    for (LogSeries& series : log_->series()) {
      if (series.accepts(*data.subscription)) receivers_[index]->push_back(&series);
    }
  }
  for (LogSeries* series : *receivers_[index]) {
    if (log_->takes(*series, *fit)) {
      series->add(reader_, data);
    } else {
      series->leave_out_absurd();
    }
  }
  return {};
}

}  // namespace attest::ulog
