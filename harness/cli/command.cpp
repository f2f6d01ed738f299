#include "harness/cli/command.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace attest::cli {

Option Option::type(const char* name) const { return Option(*option_->type_name(name)); }
Option Option::group(const char* name) const { return Option(*option_->group(name)); }
Option Option::description(const char* text) const { return Option(*option_->description(text)); }
Option Option::shows_default() const { return Option(*option_->capture_default_str()); }
Option Option::shows_default(const char* text) const { return Option(*option_->default_str(text)); }
Option Option::required() const { return Option(*option_->required()); }
Option Option::one_each_time() const { return Option(*option_->allow_extra_args(false)); }
Option Option::separated_by_commas() const { return Option(*option_->delimiter(',')); }

namespace {

// Not the checks of CLI11, whose messages have the largest double with all its 309 digits. NaN and
// infinity pass, because wrong_value() refuses them in all options.
template <typename T, typename IsRight>
CLI::Validator number_check(const std::string& name, const std::string& what, IsRight is_right) {
  const auto wrong = [what, is_right](const std::string& given) {
    T number{};
    const bool is_number = CLI::detail::lexical_cast(given, number) &&
                           (!std::isfinite(static_cast<double>(number)) || is_right(number));
    return is_number ? std::string() : fmt::format("`{}` is no {}", given, what);
  };
  return {wrong, name};
}

}  // namespace

Option Option::range(double least, double most) const {
  return Option(*option_->check(number_check<double>(
      CLI::Range(least, most).get_description(), fmt::format("number from {} to {}", least, most),
      [=](double number) { return number >= least && number <= most; })));
}
Option Option::range(int least, int most) const {
  return Option(*option_->check(
      number_check<int>(CLI::Range(least, most).get_description(),
                        fmt::format("whole number from {} to {}", least, most),
                        [=](int number) { return number >= least && number <= most; })));
}
Option Option::at_least_zero() const {
  return Option(*option_->check(number_check<double>("NONNEGATIVE", "number of at least 0",
                                                     [](double number) { return number >= 0; })));
}
Option Option::positive() const {
  return Option(*option_->check(number_check<double>("POSITIVE", "number above 0",
                                                     [](double number) { return number > 0; })));
}
Option Option::whole() const {
  // A minus would be taken as a very large number.
  return check([](const std::string& given) {
    std::uint64_t number = 0;
    const char* const end = given.data() + given.size();
    const auto [rest, wrong] = std::from_chars(given.data(), end, number);
    const bool is_whole = wrong == std::errc() && rest == end;
    return is_whole ? std::string() : fmt::format("`{}` is no whole number of at least 0", given);
  });
}
Option Option::one_of(const std::vector<std::string>& values) const {
  return Option(*option_->check(CLI::IsMember(values)));
}
Option Option::check(const std::function<std::string(const std::string&)>& wrong) const {
  return Option(*option_->check(wrong));
}

Option Option::rewritten(const std::function<std::string(const std::string&)>& rewrite) const {
  return Option(*option_->transform(CLI::Validator(
      [rewrite](std::string& given) {
        given = rewrite(given);
        return std::string();
      },
      "")));
}

Option Option::needs(Option other) const { return Option(*option_->needs(other.option_)); }
Option Option::excludes(Option other) const { return Option(*option_->excludes(other.option_)); }
bool Option::is_given() const { return option_->count() > 0; }

template <typename T>
Option Command::option(const char* name, T& value, const std::string& what) const {
  return Option(*app_->add_option(name, value, what));
}
template Option Command::option(const char*, std::string&, const std::string&) const;
template Option Command::option(const char*, std::vector<std::string>&, const std::string&) const;
template Option Command::option(const char*, std::vector<double>&, const std::string&) const;
template Option Command::option(const char*, std::filesystem::path&, const std::string&) const;
template Option Command::option(const char*, int&, const std::string&) const;
template Option Command::option(const char*, std::uint64_t&, const std::string&) const;
template Option Command::option(const char*, double&, const std::string&) const;
template Option Command::option(const char*, std::optional<int>&, const std::string&) const;
template Option Command::option(const char*, std::optional<double>&, const std::string&) const;

Option Command::flag(const char* name, bool& value, const std::string& what) const {
  return Option(*app_->add_flag(name, value, what));
}
Option Command::find(const char* name) const { return Option(*app_->get_option(name)); }

void Command::examples(std::initializer_list<Example> examples) const {
  std::string text = "\nExamples:\n";
  for (const auto& [line, what] : examples) text += fmt::format("  {}\n      {}\n", line, what);
  app_->footer(text);
}

void Command::runs(Action work) const {
  app_->callback([work = std::move(work), action = action_] { *action = work; });
}

Command CommandLine::add(const char* name, const char* what) const {
  return {*app.add_subcommand(name, what), globals, action};
}

}  // namespace attest::cli
