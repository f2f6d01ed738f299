#include "tests/controller/elementary/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <thread>

namespace attest::elementary {
namespace {

constexpr std::uint64_t chunk_size = 1 << 20;  // arguments that one thread takes at a time
constexpr std::size_t wrong_kept = 5;

void check(const Function& f, Arguments at, Truth want, Swept& swept) {
  const float got = f.fast(at.y, at.x);
  ++swept.arguments;
  add_to_hash(swept.hash, std::isnan(got) ? 0x7fc00000 : std::bit_cast<std::uint32_t>(got));
  if (want.by_mpfr) swept.hard.push_back(at);
  if (agree(got, want.value)) return;
  ++swept.differences;
  if (swept.wrong.size() < wrong_kept) swept.wrong.push_back(at);
}

// An argument and the negative one. Rounding to nearest has the symmetry of the function.
void check_signs(const Function& f, float y, Swept& swept) {
  const Truth plus = truth(f, y, 0);
  Truth minus = plus;
  if (f.symmetry == Symmetry::odd) minus.value = -minus.value;
  if (f.symmetry == Symmetry::none) minus = truth(f, -y, 0);
  check(f, {y, 0}, plus, swept);
  check(f, {-y, 0}, minus, swept);
}

void join(Swept& all, const Swept& part) {
  all.arguments += part.arguments;
  all.differences += part.differences;
  add_to_hash(all.hash, part.hash);
  all.hard.insert(all.hard.end(), part.hard.begin(), part.hard.end());
  for (const Arguments& at : part.wrong) {
    if (all.wrong.size() < wrong_kept) all.wrong.push_back(at);
  }
}

// Calls check_at(i, swept) for each i below `count`. The result does not depend on `threads`.
template <typename CheckAt>
Swept sweep(std::uint64_t count, unsigned threads, const CheckAt& check_at) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Swept> parts((count + chunk_size - 1) / chunk_size);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t part = next++; part < parts.size(); part = next++) {
      const std::uint64_t end = std::min(count, (part + 1) * chunk_size);
      for (std::uint64_t i = part * chunk_size; i < end; ++i) check_at(i, parts[part]);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  others.clear();

  Swept all;
  for (const Swept& part : parts) join(all, part);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  all.seconds = taken.count();
  return all;
}

}  // namespace

Swept sweep_arguments(const Function& f, std::uint64_t every, unsigned threads) {
  constexpr std::uint64_t sizes = std::uint64_t{1} << 31;
  return sweep((sizes + every - 1) / every, threads, [&f, every](std::uint64_t i, Swept& swept) {
    check_signs(f, std::bit_cast<float>(static_cast<std::uint32_t>(i * every)), swept);
  });
}

Swept sweep_pairs(const Function& f, std::uint64_t count, unsigned threads) {
  return sweep(count, threads, [&f](std::uint64_t i, Swept& swept) {
    const auto [y, x] = random_pair(i);
    check(f, {y, x}, truth(f, y, x), swept);
    check(f, {y, -x}, truth(f, y, -x), swept);
  });
}

}  // namespace attest::elementary
