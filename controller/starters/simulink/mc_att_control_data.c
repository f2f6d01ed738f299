/* SPDX-License-Identifier: BSD-3-Clause */
#include "mc_att_control.h"

const P mc_att_control_default_P = {
    .law_version = LawVersion_v1_5_5,
    .MC_ROLL_P = 6.5F,
    .MC_PITCH_P = 6.5F,
    .MC_YAW_P = 2.8F,
    .MC_ROLL_TC = 0.2F,
    .MC_PITCH_TC = 0.2F,
    .MC_ROLLRATE_P = 0.15F,
    .MC_ROLLRATE_I = 0.05F,
    .MC_ROLLRATE_D = 0.003F,
    .MC_PITCHRATE_P = 0.15F,
    .MC_PITCHRATE_I = 0.05F,
    .MC_PITCHRATE_D = 0.003F,
    .MC_YAWRATE_P = 0.2F,
    .MC_YAWRATE_I = 0.1F,
    .MC_YAW_FF = 0.5F,
    .MC_ROLLRATE_MAX = 220.0F,
    .MC_PITCHRATE_MAX = 220.0F,
    .MC_YAWRATE_MAX = 200.0F,
    .MC_YAWRAUTO_MAX = 45.0F,
    .MC_ACRO_R_MAX = 360.0F,
    .MC_ACRO_P_MAX = 360.0F,
    .MC_ACRO_Y_MAX = 360.0F,
    .MC_RATT_TH = 1.0F,
    .MC_TPA_BREAK = 1.0F,
    .MC_TPA_SLOPE = 1.0F,
    .VT_WV_YAWR_SCL = 0.15F,
    /* The other parameters are 0. */
};
