// Wrong in a way that is not in the catalogue of faults: it blends with the shortest rotation from
// 100 deg of tilt error instead of 90. Must fail, and the attitude law must be named.
#include "tests/ports/law_port.hpp"

namespace {

using namespace attest::mc_att_control;

struct Stages : AttitudeStages<float> {
  static bool is_upset(float cosine) { return cosine < -0.1736f; }
};

}  // namespace

ATTEST_LAW_PORT("blend from 100 deg", LawWith<Stages>)
