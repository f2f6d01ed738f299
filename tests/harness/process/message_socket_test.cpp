#include "harness/process/message_socket.hpp"

#include <array>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace attest {
namespace {

using testing::ElementsAre;
using Kind = Received::Kind;

constexpr double enough_s = 60;  // no test waits so long

class MessageSocketTest : public testing::Test {
 protected:
  MessageSocketTest() {
    std::array<int, 2> ends{-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    here_ = MessageSocket(ends[0]);
    there_ = MessageSocket(ends[1]);
  }

  // Sends bytes as another program could.
  void send_bytes(const std::string& bytes) {
    ASSERT_EQ(::write(there_.descriptor(), bytes.data(), bytes.size()),
              static_cast<ssize_t>(bytes.size()));
  }

  Received received() { return here_.receive(Patience::seconds(enough_s)); }

  MessageSocket here_{-1}, there_{-1};
};

TEST_F(MessageSocketTest, HeadAndBlobsArriveAsTheyWereSent) {
  const std::vector<int> numbers{1, 2, 3};
  const std::vector<char> letters{'a', '\0'}, none;
  ASSERT_TRUE(there_.send("head", {blob_of(numbers), blob_of(none), blob_of(letters)}));
  ASSERT_TRUE(there_.send("next"));
  const Received first = received();
  ASSERT_EQ(first.kind, Kind::message);
  EXPECT_EQ(first.head, "head");
  ASSERT_THAT(first.blobs, ElementsAre(12, 0, 2));
  std::vector<int> got_numbers(3);
  std::vector<char> got_letters(2);
  EXPECT_EQ(here_.receive_blob(got_numbers.data(), 12), Kind::message);
  EXPECT_EQ(here_.receive_blob(nullptr, 0), Kind::message);
  EXPECT_EQ(here_.receive_blob(got_letters.data(), 2), Kind::message);
  EXPECT_EQ(got_numbers, numbers);
  EXPECT_EQ(got_letters, letters);
  EXPECT_EQ(received().head, "next");
}

TEST_F(MessageSocketTest, WhatIsLargerThanTheSocketsBufferArrivesWhole) {
  const std::vector<char> large(20'000'000, 'x');
  std::thread sender([&] { EXPECT_TRUE(there_.send("head", {blob_of(large)})); });
  ASSERT_EQ(received().kind, Kind::message);
  std::vector<char> got(large.size());
  EXPECT_EQ(here_.receive_blob(got.data(), got.size()), Kind::message);
  sender.join();
  EXPECT_TRUE(got == large);
}

TEST_F(MessageSocketTest, ASilentOtherEndIsNotWaitedForLongerThanThePatience) {
  EXPECT_EQ(here_.receive(Patience::seconds(0.02)).kind, Kind::too_late);
  send_bytes("\xff");  // a message that has begun
  EXPECT_EQ(here_.receive(Patience::seconds(0.02)).kind, Kind::too_late);
  int looked = 0;
  Patience until_told = Patience::seconds(enough_s);
  until_told.given_up = [&] { return ++looked > 1; };
  EXPECT_EQ(here_.receive(until_told).kind, Kind::given_up);
}

TEST_F(MessageSocketTest, AnOtherEndThatIsGoneIsNoSignal) {
  there_ = MessageSocket(-1);
  EXPECT_EQ(received().kind, Kind::ended);
  EXPECT_FALSE(here_.send("to nobody"));
}

TEST_F(MessageSocketTest, AReaderThatDoesNotReadIsNotWaitedForForever) {
  const std::vector<char> large(20'000'000, 'x');
  EXPECT_FALSE(here_.send("head", {blob_of(large)}, Patience::seconds(0.02)));
}

TEST_F(MessageSocketTest, BytesThatAreNoMessageAreRefused) {
  send_bytes(std::string(1000, 'g'));
  EXPECT_EQ(received().kind, Kind::no_message);
}

// A receiver that accepted such a length would allocate all memory.
TEST_F(MessageSocketTest, ALengthThatIsBeyondAllMessagesIsRefused) {
  ASSERT_TRUE(there_.send("head"));
  std::string bytes(200, '\0');
  const auto length =
      static_cast<std::size_t>(::read(here_.descriptor(), bytes.data(), bytes.size()));
  bytes.resize(length);
  bytes[15] = '\x7f';  // the highest byte of the head's length
  send_bytes(bytes);
  EXPECT_EQ(received().kind, Kind::no_message);
}

}  // namespace
}  // namespace attest
