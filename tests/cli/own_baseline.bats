load common

# A suite of the own law in ./ours: two cases, one of a profile that attest does not know.
own_suite() {
  mkdir -p ours/cases/px4-v1.5.5/rates ours/cases/our-law/rates
  cp "$SOURCE/cases/px4-v1.5.5/rates/p_alone.toml" "$SOURCE/cases/px4-v1.5.5/rates/long_run.toml" \
    ours/cases/px4-v1.5.5/rates
  sed -e 's/^since = .*/profiles = ["our-law"]/' ours/cases/px4-v1.5.5/rates/p_alone.toml \
    >ours/cases/our-law/rates/p_alone.toml
}

ours() { "$ATTEST" --suite ours "$@"; }

@test "a port becomes the reference of a suite of its own" {
  own_suite
  run ours bless --port "lib:$PORTS/port_sign_flip.so" --profile px4-v1.5.5 --yes --reason "our law"
  [ "$status" -eq 0 ]
  has "blessed 2"
  provenance=ours/golden/px4-v1.5.5/provenance.toml
  grep -q "^reference = 'sign-flip .*SHA-256 [0-9a-f]\{64\})'" $provenance
  # The golden of a long case keeps every tick, because attest's own law cannot fill them in.
  grep -q "^,,4999," ours/golden/px4-v1.5.5/rates/long_run.csv

  run ours run --port "lib:$PORTS/port_sign_flip.so" --profile px4-v1.5.5 --level exact \
    --json report.json
  [ "$status" -eq 0 ]
  has "custom suite, reference sign-flip"
  grep -q '"reference": "sign-flip' report.json
  run ours run --profile px4-v1.5.5 --rate 250 # attest's own law is another one
  [ "$status" -eq 1 ]
  has "note: flights and the diagnosis need attest's own law"
  lacks "it looks like"
  run ours run --port "lib:$PORTS/port_fixed_step.so" --profile px4-v1.5.5 --rate 250
  [ "$status" -eq 2 ]
  has "the expected outputs at other times or with other parameters are not known"
  # Another port cannot make a part of the goldens.
  run ours bless --port "lib:$STARTER" --profile px4-v1.5.5 --filter '*/p_alone' --yes --reason p
  [ "$status" -eq 2 ]
  has "the golden of px4-v1.5.5/rates/long_run is of sign-flip"
  has "bless all cases with this port"
  # With its case, a golden goes, too.
  rm ours/cases/px4-v1.5.5/rates/long_run.toml
  run ours bless --port "lib:$STARTER" --profile px4-v1.5.5 --yes --reason "the other law"
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/rates/long_run: removed, because its case is gone"
  [ ! -e ours/golden/px4-v1.5.5/rates/long_run.csv ]
  lacks "sign-flip"
  run ours run --port "lib:$STARTER" --profile px4-v1.5.5 --level exact
  [ "$status" -eq 0 ]
  has "reference attest-starter-c"
}

@test "a suite whose reference is a port has no outputs for other parameters" {
  own_suite
  ours bless --port "lib:$STARTER" --profile px4-v1.5.5 --yes --reason "our law" >/dev/null
  run ours run --port "lib:$STARTER" --profile px4-v1.5.5 --rate 250 --param MC_ROLLRATE_P=0.2
  [ "$status" -eq 2 ]
  has "--param: only attest's own law can compute the expected outputs for other parameters"
  lacks "FAIL"
}

@test "a suite has one reference, and goldens of attest's own law stay as they are" {
  own_suite
  run ours bless --yes --reason "attest's" --profile px4-v1.5.5
  [ "$status" -eq 2 ] # no recordings
  run "$ATTEST" bless --port "lib:$PORTS/port_sign_flip.so" --yes --reason "our law"
  [ "$status" -eq 2 ]
  has "name its folder, which has your cases/ or a file BASE, with --suite DIR"
  run "$ATTEST" --suite "$SOURCE" bless --port "lib:$PORTS/port_sign_flip.so" --yes \
    --reason "our law"
  [ "$status" -eq 2 ]
  has "has goldens of attest's own reference; make a folder of your own"
  ours bless --port "lib:$PORTS/port_sign_flip.so" --yes --reason "our law" \
    --profile px4-v1.5.5 >/dev/null
  run ours bless --yes --reason "again" --profile px4-v1.5.5
  [ "$status" -eq 2 ]
  has "the reference of this suite is sign-flip"
}

@test "a law may have a profile name and parameters of its own" {
  own_suite
  cat >ours.py <<'P'
# The Python starter, as the law of another project.
import sys
sys.path.insert(0, sys.argv[1])
import controller, law, port
controller.PROFILES = port.PROFILES = ("our-law",)
default = law.default_parameters
controller.default_parameters = lambda profile: dict(default(law.PX4_V155), OUR_GAIN=1.0)
port.main()
P
  sed -i 's/^\[parameters\]/[parameters]\nOUR_GAIN = 2.5/' ours/cases/our-law/rates/p_alone.toml
  grep -q OUR_GAIN ours/cases/our-law/rates/p_alone.toml
  port="proc:$PYTHON ours.py $SOURCE/controller/starters/python"
  export PYTHONDONTWRITEBYTECODE=1
  run ours bless --port "$port" --profile our-law --yes --reason "our law"
  [ "$status" -eq 0 ]
  run ours run --port "$port" --profile our-law --rate 250
  [ "$status" -eq 0 ]
  has "partial: our-law"
}

@test "a suite with a BASE takes over its cases and replaces those of the same name" {
  mkdir -p ours/cases/px4-v1.5.5/rates
  sed 's/duration_ticks = .*/duration_ticks = 12/' "$SOURCE/cases/px4-v1.5.5/rates/p_alone.toml" \
    >ours/cases/px4-v1.5.5/rates/p_alone.toml
  echo released >ours/BASE
  local selection=(--group rates --profile px4-v1.5.5)
  run ours bless --port "lib:$PORTS/port_sign_flip.so" "${selection[@]}" --yes --reason "our law"
  [ "$status" -eq 0 ]
  run ours run --port "lib:$PORTS/port_sign_flip.so" "${selection[@]}" --level exact
  [ "$status" -eq 0 ]
  has "custom suite, reference sign-flip"
  grep -q "^,,11," ours/golden/px4-v1.5.5/rates/p_alone.csv # the case of ours has 12 ticks
  must_fail grep -q "^,,12," ours/golden/px4-v1.5.5/rates/p_alone.csv
  [ -e ours/golden/px4-v1.5.5/rates/long_run.csv ] # a case of the base
  run ours run "${selection[@]}" --json ours/cases/px4-v1.5.5/rates/p_alone.toml
  [ "$status" -eq 2 ]
  has "is in a suite"

  # The same cases without a base are the same suite.
  cp -r ours copied
  rm copied/BASE
  cp -rn "$SOURCE/cases" copied/
  hash() {
    "$ATTEST" --suite "$1" run --port "lib:$PORTS/port_sign_flip.so" "${selection[@]}" --rate 250 \
      --json report.json >/dev/null
    "$PYTHON" -c 'import json; print(json.load(open("report.json"))["suite"]["sha256"])'
  }
  hash ours | grep -q '^[0-9a-f]\{64\}$'
  [ "$(hash ours)" = "$(hash copied)" ]

  echo ../nowhere >ours/BASE
  run ours list
  [ "$status" -eq 2 ]
  has "ours/BASE: names \`../nowhere\`, which has no cases/ folder"
  printf 'released\n../nowhere\n' >ours/BASE
  run ours list
  [ "$status" -eq 2 ]
  has "ours/BASE:2:1: has a second line"
  echo ../ours >ours/BASE
  run ours list
  [ "$status" -eq 2 ]
  has "names \`../ours\`, which has a BASE itself"
}

@test "a reference must be repeatable, support its cases and not crash" {
  own_suite
  run ours bless --port "lib:$PORTS/port_crash.so" --profile px4-v1.5.5 --yes --reason "our law"
  [ "$status" -eq 2 ]
  has "the reference, at 100 Hz: the port's process"
  cat >noisy.py <<'P'
import sys
sys.path.insert(0, sys.argv[1])
import random, controller, port
step = controller.Controller.step
def noisy(self, inputs):
  out = step(self, inputs)
  return out._replace(controls=(random.random(), *out.controls[1:]))
controller.Controller.step = noisy
port.main()
P
  export PYTHONDONTWRITEBYTECODE=1
  run ours bless --port "proc:$PYTHON noisy.py $SOURCE/controller/starters/python" \
    --profile px4-v1.5.5 --yes --reason "our law"
  [ "$status" -eq 2 ]
  has "a reference must be repeatable"
  [ ! -e ours/golden/px4-v1.5.5 ]
  mkdir -p ours/cases/px4-v1.5.5/flight ours/cases/px4-v1.5.5/mixer
  cp "$SOURCE/cases/px4-v1.5.5/flight/hover.toml" ours/cases/px4-v1.5.5/flight
  cp "$SOURCE/cases/px4-v1.5.5/mixer/linear_quad_x.toml" ours/cases/px4-v1.5.5/mixer
  cp -r "$SOURCE/models" ours
  run ours bless --port "lib:$PORTS/port_sign_flip.so" --profile px4-v1.5.5 --yes --reason "our law"
  [ "$status" -eq 0 ]
  has "1 case without golden: flights are compared with attest's own law"
  has "1 case without golden: the port has no module mixer"
}

@test "record writes the trace of a port, which replays" {
  run "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --port "lib:$STARTER" --out mine.csv
  [ "$status" -eq 0 ]
  [ "$output" = "px4-v1.5.5/rates/p_alone@250hz  48 ticks of mc_att_control -> mine.csv" ]
  [ -z "$("$ATTEST" -q record p_alone "$STARTER" --out mine.csv)" ]
  run "$ATTEST" replay mine.csv --level exact
  [ "$status" -eq 0 ]
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 | cmp - mine.csv
  run "$ATTEST" record px4-v1.5.5/flight/hover --rate 250
  [ "$status" -eq 2 ]
  has "is a flight; \`attest sim --out F\` flies it"
  run "$ATTEST" record --case p_alone "$STARTER" --rate 250
  [ "$output" = "$(cat mine.csv)" ]
  run "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --port "lib:$PORTS/port_crash.so" \
    --out no.csv
  [ "$status" -eq 2 ]
  has "the port's process"
  [ ! -e no.csv ]
}

@test "record takes a case that the port has, of the release that is asked for" {
  run "$ATTEST" record disarmed # of the battery estimate or of the attitude unit
  [ "$status" -eq 2 ]
  has "\`disarmed\` matches"
  run "$ATTEST" record disarmed "$PORTS/port_other_profiles.so" --out mine.csv
  [ "$status" -eq 0 ]
  has "px4-v1.18/spool_up/disarmed@250hz  200 ticks of attitude_unit"
  rate_only mine
  run "$ATTEST" record p_alone mine.so --profile v1.16 --out mine.csv
  [ "$status" -eq 0 ]
  has "px4-v1.16.0/rates/p_alone@250hz"
  run "$ATTEST" record landed mine.so --out mine.csv
  [ "$status" -eq 2 ]
  has "px4-v1.18/rate_law/landed@250hz: the port has no module rate_law"
  has "\`attest list --group landed\`"
  run "$ATTEST" record px4-v1.5.5/rates/p_alone mine.so --profile v1.18
  [ "$status" -eq 2 ]
  has "no case with --profile px4-v1.18 matches"
}

@test "run --param sets a parameter for port and reference" {
  filter=(--filter 'rates/*@250hz' --profile px4-v1.5.5)
  run "$ATTEST" run --port "lib:$STARTER" --level exact "${filter[@]}" --param MC_ROLLRATE_P=0.3
  [ "$status" -eq 0 ]
  has "with MC_ROLLRATE_P=0.3"
  # These cases leave the time constant at its default, with which the fault cannot be seen.
  run "$ATTEST" run --port fault:tc-ignored --filter px4-v1.5.5/rates/p_alone@250hz
  [ "$status" -eq 0 ]
  run "$ATTEST" run --port fault:tc-ignored --filter px4-v1.5.5/rates/p_alone@250hz \
    --param MC_ROLL_TC=0.3
  [ "$status" -eq 1 ]
  run "$ATTEST" run "${filter[@]}" --param MC_ROLLRATE_Q=0.3
  [ "$status" -eq 2 ]
  has "did you mean \`MC_ROLLRATE_P\`"
  run "$ATTEST" run "${filter[@]}" --param MC_ROLLRATE_P
  [ "$status" -eq 2 ]
  has "write NAME=VALUE"
  run "$ATTEST" run --filter '*/hover' --param MC_ROLLRATE_P=0.3
  [ "$status" -eq 2 ]
  has "--param leaves them out"
}

@test "cases without a golden in a suite with a base are judged by the reference, flights too" {
  local flights=(--filter 'px4-v1.5.5/flight/own_hover@250hz-*-ode')
  mkdir -p ours/cases/px4-v1.5.5/{flight,rates}
  cp "$SOURCE/cases/px4-v1.5.5/flight/hover.toml" ours/cases/px4-v1.5.5/flight/own_hover.toml
  cp "$SOURCE/cases/px4-v1.5.5/rates/p_alone.toml" ours/cases/px4-v1.5.5/rates/own_p.toml
  cp -r "$SOURCE/models" ours
  echo released >ours/BASE
  run ours doctor
  [ "$status" -eq 0 ]
  has "the reference alone judges"
  run ours run "${flights[@]}"
  [ "$status" -eq 0 ]
  has "; the reference alone judged "
  run ours run "${flights[@]}" --port fault:i-subtracted --no-diagnose
  [ "$status" -eq 1 ]
  run ours run --filter 'px4-v1.5.5/rates/own_p@250hz' --port fault:yawrate-p-not-read --no-diagnose
  [ "$status" -eq 1 ]

  # A golden whose origin is lost is an error. It is not judged by the reference.
  run ours bless --port "lib:$PORTS/port_sign_flip.so" --group rates --profile px4-v1.5.5 --yes \
    --reason "our law"
  [ "$status" -eq 0 ]
  rm ours/golden/px4-v1.5.5/provenance.toml
  run ours run --filter 'px4-v1.5.5/rates/own_p@250hz'
  [ "$status" -eq 2 ]
  lacks "PASS"
}
