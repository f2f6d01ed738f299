// Strict reading of TOML files: each key of a file must be read, and each error names file, line
// and column.
//
// Errors are collected, so that the reading code need not stop at each one and a file's author sees
// all errors together:
//
//     auto file = TomlFile::read(path);              // syntax errors
//     if (!file) return tl::unexpected(file.error());
//     const TomlTable root = file->root();
//     const std::string why = root.text("why");      // required: its absence is an error
//     const double thrust = root.number("thrust", 0.5);
//     if (auto done = file->finish(); !done) ...     // all errors, and unknown keys
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

enum class TomlKind { absent, boolean, integer, number, text, array, table };

// A view of one table. All views of the same table share the record of the keys that were read.
class TomlTable {
 public:
  // kind() is `text` for a date or time without quotes, so that text() can report the error. kind()
  // and has() do not count as reading: a key that only they looked at is an error in finish().
  TomlKind kind(std::string_view key) const;
  bool has(std::string_view key) const { return kind(key) != TomlKind::absent; }

  // The line of the key's value, from 1; 0 when the key is absent. Does not count as reading.
  int line(std::string_view key) const;

  // Keys in the order of the file. Does not count as reading.
  std::vector<std::string> keys() const;

  // Required keys. A key that is absent or of another type is an error; the value is then empty or
  // 0. The missing keys of an absent table are not reported in addition. number() accepts an
  // integer; nan and inf are numbers.
  std::string text(std::string_view key) const;
  double number(std::string_view key) const;
  std::int64_t integer(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<std::int64_t> integers(std::string_view key) const;
  TomlTable table(std::string_view key) const;

  // Optional keys: an absent key gives the fallback. A key of another type is an error, and gives
  // the fallback, too.
  std::string text(std::string_view key, std::string fallback) const;
  double number(std::string_view key, double fallback) const;
  std::int64_t integer(std::string_view key, std::int64_t fallback) const;
  bool boolean(std::string_view key, bool fallback) const;
  // The texts of the table `key`, by their keys. An absent table is empty.
  std::map<std::string, std::string> text_table(std::string_view key) const;

  // Records an error at the key's place (at the table's when the key is absent). Counts as reading.
  void error(std::string_view key, const std::string& message) const;

  struct Impl;
  explicit TomlTable(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

 private:
  std::shared_ptr<Impl> impl_;
};

class TomlFile {
 public:
  static Result<TomlFile> read(const std::filesystem::path& path);
  // `name` stands for the file in messages.
  static Result<TomlFile> parse(std::string_view text, const std::string& name);

  TomlTable root() const;

  // Returns the first error in file order. Keys that were not read are errors, too ("unknown key
  // `thurst`; did you mean `thrust`?"). Later errors are appended to its message, one per line,
  // each with its own place. For a table that was not read, only the table is listed, not its keys.
  Result<void> finish() const;

  // A text that is the same for all files with the same data. It does not depend on comments, white
  // space, the order of keys, the notation of a table, and the notation of a number: 5, 5.0 and 0x5
  // are equal. It keeps all bits of a number, and the sign of 0. `without`: keys that are left out,
  // "why" in the root or "tolerance.why" in a table of the root.
  std::string canonical(std::span<const std::string_view> without = {}) const;

  struct Document;

 private:
  explicit TomlFile(std::shared_ptr<Document> document) : document_(std::move(document)) {}
  std::shared_ptr<Document> document_;
};

// Builds a file: tables and values are written in alphabetical order of their keys.
class TomlWriter {
 public:
  TomlWriter();
  ~TomlWriter();
  TomlWriter(const TomlWriter&) = delete;
  TomlWriter& operator=(const TomlWriter&) = delete;

  // Sets `key` of the table named `table`; an empty `table` is the root.
  void set(std::string_view table, std::string_view key, std::string_view value);
  void set(std::string_view table, std::string_view key, double value);
  void set(std::string_view table, std::string_view key, std::int64_t value);
  void set(std::string_view table, std::string_view key, const std::vector<std::string>& values);

  void set(std::string_view table, std::string_view key, const std::vector<double>& values);
  void set(std::string_view table, std::string_view key, const std::vector<std::int64_t>& values);
  // Sets `key` of the table `inner`, which is in `table`.
  void set(std::string_view table, std::string_view inner, std::string_view key,
           std::string_view value);
  void set(std::string_view table, std::string_view inner, std::string_view key,
           const std::vector<double>& values);

  std::string to_string() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace attest
