#include "harness/plant/mujoco_model_copy.hpp"

#include <cstring>
#include <type_traits>

#include <mujoco/mjxmacro.h>
#include <mujoco/mujoco.h>

namespace attest {
namespace {

std::size_t aligned(std::size_t bytes) {
  constexpr std::size_t alignment = alignof(std::max_align_t);
  return (bytes + alignment - 1) / alignment * alignment;
}

// Calls `act` with the pointer to each array and its size in bytes.
template <typename Act>
void for_each_array(mjModel& model, Act&& act) {
  MJMODEL_POINTERS_PREAMBLE((&model))
#define X(type, name, rows, columns) \
  act(model.name,                    \
      sizeof(type) * static_cast<std::size_t>(model.rows) * static_cast<std::size_t>(columns));
  MJMODEL_POINTERS
#undef X
}

}  // namespace

MujocoModelCopy::MujocoModelCopy(const mjModel& original)
    : model_(std::make_unique<mjModel>(original)) {
  model_->buffer = nullptr;  // belongs to the original
  model_->ntex = model_->ntexdata = 0;
  std::size_t bytes = 0;
  for_each_array(*model_, [&](const auto&, std::size_t size) { bytes += aligned(size); });
  memory_.resize(bytes);
  std::byte* next = memory_.data();
  for_each_array(*model_, [&](auto*& array, std::size_t size) {
    if (size > 0) std::memcpy(next, array, size);
    array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(next);
    next += aligned(size);
  });
}

MujocoModelCopy::~MujocoModelCopy() = default;

}  // namespace attest
