#include "harness/process/message_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace attest {
namespace {

using Kind = Received::Kind;
using Clock = std::chrono::steady_clock;

// The first bytes of a message. Valid UTF-8 never begins with them.
constexpr std::uint32_t magic = 0xa77e57ff;
constexpr std::size_t most_blobs = 8;
// A larger number is not the length of a head. The longest heads have the parameters of a trace.
constexpr std::uint64_t longest_head = std::uint64_t{64} << 20;

struct Prefix {
  std::uint32_t magic;
  std::uint32_t blobs;
  std::uint64_t head;                          // bytes
  std::array<std::uint64_t, most_blobs> blob;  // bytes of each
};

bool is_sane(const Prefix& prefix) {
  return prefix.magic == magic && prefix.blobs <= most_blobs && prefix.head <= longest_head;
}

// A message of sendmsg() that carries descriptors. It also has one byte of data, because the system
// does not send descriptors without data.
class DescriptorMessage {
 public:
  DescriptorMessage() {
    header_.msg_iov = &data_;
    header_.msg_iovlen = 1;
    header_.msg_control = control_.data();
    header_.msg_controllen = control_.size();
  }
  DescriptorMessage(const DescriptorMessage&) = delete;
  DescriptorMessage& operator=(const DescriptorMessage&) = delete;

  bool send(int socket, std::span<const int> descriptors) {
    header_.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* const head = CMSG_FIRSTHDR(&header_);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(head), descriptors.data(), descriptors.size_bytes());
    return ::sendmsg(socket, &header_, MSG_NOSIGNAL) == sizeof byte_;
  }

  std::vector<int> receive(int socket) {
    if (::recvmsg(socket, &header_, MSG_CMSG_CLOEXEC) != sizeof byte_) return {};
    const cmsghdr* const head = CMSG_FIRSTHDR(&header_);
    if (head == nullptr || head->cmsg_type != SCM_RIGHTS) return {};
    std::vector<int> descriptors((head->cmsg_len - CMSG_LEN(0)) / sizeof(int));
    std::memcpy(descriptors.data(), CMSG_DATA(head), descriptors.size() * sizeof(int));
    return descriptors;
  }

 private:
  static constexpr std::size_t most_descriptors = 8;

  char byte_ = 0;
  iovec data_{&byte_, sizeof byte_};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(most_descriptors * sizeof(int))> control_{};
  msghdr header_{};
};

// Waits until the descriptor is ready. Returns the reason if the waiting ended before that.
std::optional<Kind> wait_for(int descriptor, short what, const Patience& patience) {
  constexpr double look_every_ms = 100;  // period of the calls of given_up()
  while (true) {
    if (patience.given_up()) return Kind::given_up;
    double wait_ms = look_every_ms;
    if (patience.until != Clock::time_point::max()) {
      const std::chrono::duration<double, std::milli> left = patience.until - Clock::now();
      if (left.count() <= 0) return Kind::too_late;
      wait_ms = std::min(wait_ms, left.count());
    }
    pollfd ready{descriptor, what, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(std::ceil(wait_ms)));
    if (count > 0) return std::nullopt;
    if (count < 0 && errno != EINTR) return Kind::ended;
  }
}

}  // namespace

Patience Patience::seconds(double seconds) {
  constexpr double longest_s = 1e9;
  const std::chrono::duration<double> limit(std::min(seconds, longest_s));
  Patience patience;
  patience.until = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
  return patience;
}

MessageSocket::MessageSocket(int descriptor) : descriptor_(descriptor), owner_(::getpid()) {}

MessageSocket::MessageSocket(MessageSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), owner_(other.owner_) {}

MessageSocket& MessageSocket::operator=(MessageSocket&& other) noexcept {
  if (this == &other) return *this;
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = std::exchange(other.descriptor_, -1);
  owner_ = other.owner_;
  return *this;
}

MessageSocket::~MessageSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool MessageSocket::write_all(std::string_view bytes, const Patience& patience) {
  while (!bytes.empty()) {
    // MSG_NOSIGNAL: a closed other end is an error here, not a signal.
    const ssize_t sent =
        ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (wait_for(descriptor_, POLLOUT, patience)) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool MessageSocket::send(std::string_view head, const std::vector<Blob>& blobs,
                         const Patience& patience) {
  if (::getpid() != owner_) return false;
  Prefix prefix{magic, static_cast<std::uint32_t>(blobs.size()), head.size(), {}};
  for (std::size_t i = 0; i < blobs.size(); ++i) prefix.blob.at(i) = blobs[i].size;
  std::string start(sizeof prefix, '\0');
  std::memcpy(start.data(), &prefix, sizeof prefix);
  start += head;
  if (!write_all(start, patience)) return false;
  return std::all_of(blobs.begin(), blobs.end(), [&](const Blob& blob) {
    return write_all({static_cast<const char*>(blob.data), blob.size}, patience);
  });
}

Kind MessageSocket::receive_blob(void* place, std::size_t size, const Patience& patience) {
  char* bytes = static_cast<char*>(place);
  while (size > 0) {
    const ssize_t got = ::recv(descriptor_, bytes, size, MSG_DONTWAIT);
    if (got > 0) {
      bytes += got;
      size -= static_cast<std::size_t>(got);
    } else if (got == 0) {
      return Kind::ended;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (const auto why = wait_for(descriptor_, POLLIN, patience)) return *why;
    } else if (errno != EINTR) {
      return Kind::ended;
    }
  }
  return Kind::message;
}

bool MessageSocket::send_descriptors(std::span<const int> descriptors) {
  return ::getpid() == owner_ && DescriptorMessage().send(descriptor_, descriptors);
}

std::vector<int> MessageSocket::receive_descriptors() {
  return DescriptorMessage().receive(descriptor_);
}

Received MessageSocket::receive(const Patience& patience) {
  Prefix prefix{};
  Received received;
  received.kind = receive_blob(&prefix, sizeof prefix, patience);
  if (received.kind != Kind::message) return received;
  if (!is_sane(prefix)) return {Kind::no_message};
  received.head.resize(prefix.head);
  received.kind = receive_blob(received.head.data(), received.head.size(), patience);
  received.blobs.assign(prefix.blob.begin(), prefix.blob.begin() + prefix.blobs);
  return received;
}

}  // namespace attest
