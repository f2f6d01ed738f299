#include "harness/compare/publication.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace attest {
namespace {

// For each output the channel that tells whether it was published; null if there is none.
using Publishers = std::array<const Channel*, max_channels>;

Publishers find_publishers() {
  Publishers all{};
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!channel.is_output()) continue;
    const std::string topic(channel.name.substr(0, channel.name.find('.')));
    const auto flag = find_channel(channel.module, topic + ".published");
    if (flag) all[i] = &channels()[*flag];
  }
  return all;
}

}  // namespace

bool is_published(const Channel& output, const Sample& sample) {
  static const Publishers publishers = find_publishers();
  const auto index = static_cast<std::size_t>(&output - channels().data());
  const Channel* const flag = publishers[index];
  return flag == nullptr || value_of(*flag, sample) != 0;
}

}  // namespace attest
