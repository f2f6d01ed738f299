// Messages between two processes of attest, over a pair of sockets. A message is a head (text),
// followed by blobs (bytes). The content of both is not interpreted here.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <sys/types.h>

namespace attest {

// Bytes to be sent. They are not copied.
struct Blob {
  const void* data = nullptr;
  std::size_t size = 0;
};

// The objects of a vector as a blob. The vector must outlive the blob.
template <typename T>
Blob blob_of(const std::vector<T>& objects) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {objects.data(), objects.size() * sizeof(T)};
}

// How long to wait, and the condition that ends the waiting early.
struct Patience {
  std::chrono::steady_clock::time_point until = std::chrono::steady_clock::time_point::max();
  // Called about every 100 ms while waiting; true ends the waiting.
  std::function<bool()> given_up = [] { return false; };

  static Patience seconds(double seconds);
};

// The result of waiting for a message.
struct Received {
  enum class Kind {
    message,
    ended,      // the other process closed its end, or died, perhaps in the middle of a message
    too_late,   // no complete message in time
    given_up,   // Patience::given_up returned true
    no_message  // the bytes are no message; the socket must not be read any more
  };
  Kind kind = Kind::ended;
  std::string head = {};
  std::vector<std::size_t> blobs = {};  // the size of each; receive_blob() reads them next
};

// One end of a pair of sockets. Only the process that made this object can send: in its forks
// send() and send_descriptors() return false.
class MessageSocket {
 public:
  explicit MessageSocket(int descriptor);  // owned
  MessageSocket(MessageSocket&& other) noexcept;
  MessageSocket& operator=(MessageSocket&& other) noexcept;
  ~MessageSocket();

  // For poll(): readable when bytes arrived, or the other end was closed.
  int descriptor() const { return descriptor_; }

  // REQUIRES: at most 8 blobs. False: not all was sent, because the other end is closed or
  // `patience` ended.
  bool send(std::string_view head, const std::vector<Blob>& blobs = {},
            const Patience& patience = {});

  // Receives the head of the next message. REQUIRES: all blobs of the previous message were read.
  Received receive(const Patience& patience = {});

  // Receives the next blob of the message into `place`. REQUIRES: `size` is its size in
  // Received::blobs. Returns `message` if the blob is complete.
  Received::Kind receive_blob(void* place, std::size_t size, const Patience& patience = {});

  // Sends copies of at most 8 descriptors. The other end must then call receive_descriptors().
  bool send_descriptors(std::span<const int> descriptors);

  // Waits for descriptors, which the caller then owns. Empty: the other end is closed, or sent
  // something else.
  std::vector<int> receive_descriptors();

 private:
  bool write_all(std::string_view bytes, const Patience& patience);

  int descriptor_ = -1;
  pid_t owner_;
};

}  // namespace attest
