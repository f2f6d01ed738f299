// Binary frames: a header and a payload. Inputs and outputs are the ABI's structs as in memory.
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "harness/port/conversation.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/csv_cells.hpp"

namespace attest {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

struct Header {
  std::uint32_t size;  // of the payload
  Request kind;
  std::uint32_t unit;
  std::uint32_t sequence;
};
static_assert(sizeof(Header) == 16);

// The structs of a module within a sample.
std::string_view inputs_of(Module module, const Sample& sample) {
  const Block& in = info_of(module).in;
  return {static_cast<const char*>(in.in(sample)), in.size};
}

std::span<char> outputs_of(Module module, Sample& sample) {
  const Block& out = info_of(module).out;
  return {static_cast<char*>(out.in(sample)), out.size};
}

std::uint32_t number(Request kind) { return static_cast<std::uint32_t>(kind); }

void append(std::string& bytes, const auto& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class BinaryConversation final : public Conversation {
 public:
  BinaryConversation(PipedProgram program, Hello hello)
      : Conversation(std::move(program), std::move(hello)) {}

  int create(std::uint32_t unit, Module module, const std::string& profile,
             const std::string& definition) override {
    begin(Request::create, unit);
    append(frame_, static_cast<std::uint32_t>(module));
    append(frame_, static_cast<std::uint32_t>(profile.size()));
    frame_ += profile;
    frame_ += definition;
    return result_of_request(0);
  }

  int destroy(std::uint32_t unit) override {
    begin(Request::destroy, unit);
    return result_of_request(0);
  }

  int set_parameter(std::uint32_t unit, const std::string& name, float value) override {
    begin(Request::set_parameter, unit);
    append(frame_, value);
    frame_ += name;
    return result_of_request(0);
  }

  int step(std::uint32_t unit, Module module, ProgramStep& step) override {
    begin(Request::step, unit);
    append(frame_, step.timestamp_sample_us);
    frame_ += inputs_of(module, step.sample);
    const std::span<char> out = outputs_of(module, step.sample);
    const int result = result_of_request(out.size() + size_of_cost());
    take_outputs(out, step.cost);
    return result;
  }

  int batch(std::uint32_t unit, Module module, std::span<ProgramStep> steps,
            std::size_t& done) override {
    begin(Request::batch, unit);
    append(frame_, static_cast<std::uint32_t>(steps.size()));
    append(frame_, std::uint32_t{0});
    for (const ProgramStep& step : steps) {
      append(frame_, step.timestamp_sample_us);
      frame_ += inputs_of(module, step.sample);
    }
    return result_of_batch(module, steps, done);
  }

 private:
  void begin(Request kind, std::uint32_t unit) {
    frame_.clear();
    append(frame_, Header{0, kind, unit, next_sequence()});
  }

  Header sent() const {
    Header header;
    std::memcpy(&header, frame_.data(), sizeof header);
    return header;
  }

  // Sends the frame, and reads the header of the answer.
  Header exchange() {
    const auto payload = static_cast<std::uint32_t>(frame_.size() - sizeof(Header));
    std::memcpy(frame_.data(), &payload, sizeof payload);
    if (!program().write(frame_)) ended(sent().kind);
    Header answer;
    take(&answer, sizeof answer);
    const Header question = sent();
    if (answer.kind < Request::create || answer.kind > Request::batch) {
      const std::string_view bytes(reinterpret_cast<const char*>(&answer), sizeof answer);
      broken(question.kind, fmt::format("begins with the bytes {}, which are no header of a frame; "
                                        "text for people belongs on stderr",
                                        in_backquotes(bytes)));
    }
    if (answer.kind != question.kind || answer.unit != question.unit ||
        answer.sequence != question.sequence) {
      broken(question.kind,
             fmt::format("has kind {}, unit {}, sequence number {}; they must be those of the "
                         "request: {}, {}, {}",
                         number(answer.kind), answer.unit, answer.sequence, number(question.kind),
                         question.unit, question.sequence));
    }
    return answer;
  }

  // Sends the request, and returns the result in the answer. `rest` bytes must follow the result;
  // the caller reads them.
  int result_of_request(std::size_t rest) {
    const Header answer = exchange();
    check_size(answer, sizeof(std::uint32_t) + rest);
    return take_number();
  }

  int result_of_batch(Module module, std::span<ProgramStep> steps, std::size_t& done) {
    constexpr std::size_t head = 2 * sizeof(std::uint32_t);
    const std::size_t each = outputs_of(module, steps.front().sample).size() + size_of_cost();
    const Header answer = exchange();
    if (answer.size < head || answer.size > head + steps.size() * each) {
      broken(Request::batch, fmt::format("has a payload of {} bytes; {} to {} are possible",
                                         answer.size, head, head + steps.size() * each));
    }
    const int result = take_number();
    done = static_cast<std::uint32_t>(take_number());
    if (done > steps.size() || (done < steps.size()) != (result != ATTEST_OK)) {
      broken(Request::batch,
             fmt::format("has the result {} after {} of {} steps", result, done, steps.size()));
    }
    check_size(answer, head + done * each);
    for (ProgramStep& step : steps.first(done)) {
      take_outputs(outputs_of(module, step.sample), step.cost);
    }
    return result;
  }

  std::size_t size_of_cost() const { return hello().cost ? sizeof(StepCost) : 0; }

  // The outputs of a step and, if the program counts it, its cost.
  void take_outputs(std::span<char> out, StepCost& cost) {
    take(out.data(), out.size());
    if (hello().cost) take(&cost, sizeof cost);
  }

  void check_size(const Header& answer, std::size_t size) {
    if (answer.size == size) return;
    broken(answer.kind, fmt::format("has a payload of {} bytes instead of {}", answer.size, size));
  }

  int take_number() {
    std::int32_t number = 0;
    take(&number, sizeof number);
    return number;
  }

  void take(void* place, std::size_t size) {
    if (!program().read(place, size)) ended(sent().kind);
  }

  std::string frame_;  // the request
};

}  // namespace

std::unique_ptr<Conversation> binary_conversation(PipedProgram program, Hello hello) {
  return std::make_unique<BinaryConversation>(std::move(program), std::move(hello));
}

}  // namespace attest
