// A file as a window of 1 MiB that moves with its reader, so memory does not grow with the file.
#pragma once

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "harness/core/file.hpp"

namespace attest::ulog {

class Window {
 public:
  // Errors: those of open_regular_file().
  static Result<Window> open(const std::filesystem::path& path) {
    const auto descriptor = open_regular_file(path);
    if (!descriptor) return tl::unexpected(descriptor.error());
    Window window;
    window.file_ = path.string();
    window.stream_.reset(::fdopen(*descriptor, "rb"));
    std::setvbuf(window.stream_.get(), nullptr, _IONBF, 0);  // the window is the buffer
    ::fseeko(window.stream_.get(), 0, SEEK_END);
    window.file_size_ = static_cast<std::uint64_t>(::ftello(window.stream_.get()));
    return window;
  }

  const std::string& file() const { return file_; }
  std::uint64_t file_size() const { return file_size_; }            // bytes, when opened
  const std::optional<Error>& failure() const { return failure_; }  // of a read

  // What the window has from `offset` on: at least `count` bytes, fewer only at the end of the file
  // or after a failure. Valid until the next call. REQUIRES: count <= 1 MiB.
  std::string_view from(std::uint64_t offset, std::size_t count) {
    if (offset < begin_ || offset + count > begin_ + used_) move_to(offset);
    const auto start = static_cast<std::size_t>(offset - begin_);
    return {buffer_.get() + start, used_ - start};
  }

 private:
  static constexpr std::size_t capacity = std::size_t{1} << 20;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void move_to(std::uint64_t offset) {
    const bool overlaps = offset >= begin_ && offset < begin_ + used_;
    const std::size_t kept = overlaps ? static_cast<std::size_t>(begin_ + used_ - offset) : 0;
    std::memmove(buffer_.get(), buffer_.get() + (used_ - kept), kept);
    begin_ = offset;
    used_ = kept;
    ::fseeko(stream_.get(), static_cast<off_t>(begin_ + used_), SEEK_SET);
    used_ += std::fread(buffer_.get() + used_, 1, capacity - used_, stream_.get());
    if (std::ferror(stream_.get()) == 0) return;
    const std::string reason = std::generic_category().message(errno);
    failure_ = Error{"cannot read the file: " + reason, file_};
  }

  std::string file_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::unique_ptr<char[]> buffer_{new char[capacity]};
  std::uint64_t file_size_ = 0;
  std::uint64_t begin_ = 0;  // in the file
  std::size_t used_ = 0;
  std::optional<Error> failure_;
};

}  // namespace attest::ulog
