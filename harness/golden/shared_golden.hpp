// The file of the goldens of a case file, as CSV: golden/<folder>/<group>/<name>.csv for
// cases/<folder>/<group>/<name>.toml. It has the goldens (golden_file.hpp) of all profiles of the
// case, with one more column:
//
//     profiles,configurations,tick,out/vehicle_rates_setpoint.roll
//     px4-v1.17 px4-v1.18,50hz 100hz,0,0.38800925
//     ,,1,-0.90893227
//     px4-v1.18,250hz,0,0.4711
//
// A row that names profiles begins a trace of these profiles. So the golden of a profile is the
// header and the traces that name it, without the column `profiles`.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace attest {

using GoldensByProfile = std::map<std::string, std::string>;  // profile -> text of its golden

// The golden of one profile in the text of a file. Without a trace if the file does not name the
// profile; empty if the text is not that of such a file.
std::string golden_of_profile(std::string_view file, std::string_view profile);

// The goldens of all profiles that the text of a file names.
GoldensByProfile goldens_in(std::string_view file);

// Whether two goldens have the same columns, so that they can share a file.
bool have_same_columns(std::string_view golden, std::string_view other);

// The text of the file. A trace that several goldens have is written once, and each golden keeps
// the order of its traces. REQUIRES: at least one golden; all have the same columns.
std::string joined(const GoldensByProfile& goldens);

// Whether the file can name this profile.
bool can_share(std::string_view profile);

}  // namespace attest
