# `vectors --lint` for the units of the cascade: for each decision of the law a case too near to it.

load common

# refuses DECISION MODULE: the rest of the case is on stdin. Tick 4 comes too near.
refuses() {
  mkdir -p suite/cases/px4-v1.16.0/tests suite/golden
  {
    printf 'schema = 1\nprofiles = ["px4-v1.16.0"]\ngroup = "tests"\nmodule = "%s"\n' "$2"
    printf 'why = "x"\nduration_ticks = 10\nrates_hz = [250]\nrates_why = "x"\n'
    cat
  } >suite/cases/px4-v1.16.0/tests/near.toml
  run "$ATTEST" --suite suite vectors --lint
  [ "$status" -eq 1 ]
  has "near.toml: at 250hz, tick 4, $1 is at"
  has "1 numeric vectors, 1 too near to a decision"
}

stabilized='[vehicle_control_mode]
flag_control_manual_enabled = 1
flag_control_altitude_enabled = 0
flag_control_velocity_enabled = 0
flag_control_position_enabled = 0
'

# after A B: A, and B from tick 4 on.
after() { echo "{ signal = \"samples\", times_ticks = [0, 4], values = [$1, $2] }"; }

@test "a rotation that either way is as short, and one about an arbitrary axis" {
  refuses "shorter rotation" attitude_unit <<<"
[vehicle_attitude]
q = { tilt_deg = $(after 0 179.9999) }"
  refuses "tilt at 180 deg" attitude_unit <<<"
[vehicle_attitude]
q = { azimuth_deg = 30, tilt_deg = $(after 0 179.99) }"
  refuses "opposite thrust" attitude_unit <<<"
[vehicle_attitude]
q = { tilt_deg = $(after 0 179.487172) }"
}

@test "half a turn of yaw, and the weight above which the yaw gain is divided by it" {
  refuses "yaw at +-180 deg" attitude_unit <<<"
[vehicle_attitude]
q = { yaw_deg = $(after 0 179.9999) }"
  refuses "yaw weight" attitude_unit <<<"
[parameters]
MC_YAW_WEIGHT = $(after 0.4 1e-4)"
}

@test "the time since arming, and the lowest throttle" {
  refuses "spool-up time" attitude_unit <<<"
[parameters]
COM_SPOOLUP_TIME = 0.516
[vehicle_status]
armed_time = -0.5
publish_at_ticks = [0, 4]"
  refuses "lowest throttle" attitude_unit <<<"$stabilized
[manual_control_setpoint]
throttle = $(after 0 -0.9)"
}

@test "the heading: at a pole, at half a turn, and when it has converged" {
  refuses "heading's pole" attitude_unit <<<"$stabilized
[vehicle_attitude]
q = { pitch_deg = $(after 0 89.94) }"
  refuses "heading at +-180 deg" attitude_unit <<<"$stabilized
[manual_control_setpoint]
throttle = -1
[vehicle_attitude]
q = { yaw_deg = $(after 0 -179.99999) }"
  refuses "heading's convergence" attitude_unit <<<"$stabilized
[vehicle_local_position]
unaided_heading = $(after 0 -0.0174532)"
}

@test "the yaw rate at which the heading is locked" {
  refuses "yaw lock" attitude_unit <<<"$stabilized
[parameters]
MPC_MAN_Y_TAU = 0
MPC_MAN_Y_MAX = 150
MPC_YAW_EXPO = 0
MPC_HOLD_DZ = 0
[manual_control_setpoint]
yaw = $(after 0 4.5534877e-8)"
}

@test "the rate unit: saturation, cutoff, battery scale, overflow" {
  refuses "saturation flag" rate_unit <<<"
[control_allocator_status]
torque_setpoint_achieved = 0
\"unallocated_torque[1]\" = $(after 0 -1.1920929e-7)"
  refuses "yaw cutoff" rate_unit <<<"
[parameters]
MC_YAW_TQ_CUTOFF = $(after 2 1.1920929e-7)"
  refuses "battery scale" rate_unit <<<"
[parameters]
MC_BAT_SCALE_EN = 1
[battery_status]
scale = $(after 1 1e-9)"
  refuses "overflow" rate_unit <<<"
[parameters]
MC_ROLLRATE_P = 1
[vehicle_angular_velocity]
\"xyz[0]\" = $(after 0 3.40282e38)"
}
