load common

# The program that answers knows the CSV files and nothing of attest (tests/ports/recorded).
answer() {
  PYTHONDONTWRITEBYTECODE=1 "$PYTHON" "$SOURCE/tests/ports/recorded/board.py" \
    "$SOURCE/controller/starters/python" vectors "$@"
}

# answered MISTAKE TEXT...: one vector, recorded with a mistake, fails, and the mistake is named.
answered() {
  rm -rf vectors
  "$ATTEST" vectors vectors --filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz >/dev/null
  answer --mistake "$1"
  run "$ATTEST" run --port recorded:vectors --no-diagnose \
    --filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz
  [ "$status" -eq 1 ]
  for text in "${@:2}"; do has "$text"; done
}

@test "recorded outputs are judged as those of any port" {
  # Without the files of 70,000 ticks, which the board needs 10 s to answer, and without the laws.
  "$ATTEST" vectors vectors --rate 250 --exclude 'mixer/*' --exclude 'px4-v1.1*' \
    --exclude '*_law/*' --exclude '*/steps_beyond_16_bits' >/dev/null
  answer
  run "$ATTEST" run --port recorded:vectors --rate 250 --exclude '*_law/*' \
    --exclude '*/steps_beyond_16_bits'
  [ "$status" -eq 0 ]
  [[ $output =~ note:\ [0-9]+\ of\ [0-9]+\ selected\ vectors\ have\ outputs\ in\ vectors ]]
  [[ $output =~ PASS\ [0-9]{3}\ vectors\ passed,\ 0\ failed\; ]]
  has "134 skip: a recorded port does not fly"
  has " skip: not answered"
  has "partial: px4-v1.5.5, numeric, 1 rate, groups actuators, anti_windup, arming"
  lacks "with mixer"
  rm vectors/px4-v1.5.5/rates/p_alone/250hz.out.csv
  run "$ATTEST" run --port recorded:vectors --profile px4-v1.5.5 --rate 250
  [ "$status" -eq 0 ]
  has "and parts of rates"
}

@test "a mistake in the port is diagnosed" {
  "$ATTEST" vectors vectors --rate 250 --profile px4-v1.5.5 --group attitude >/dev/null
  answer --mistake law
  run "$ATTEST" run --port recorded:vectors --rate 250 --profile px4-v1.5.5 --group attitude
  [ "$status" -eq 1 ]
  has "look first at the attitude law"
  has "out/vehicle_rates_setpoint.yaw looks like the expected values with the other sign"
}

@test "a mistake in the recording is named" {
  answered degrees "out/vehicle_rates_setpoint.roll" "57.3 times the expected values: in degrees"
  answered exchanged \
    "out/vehicle_rates_setpoint.roll has the values expected of out/vehicle_rates_setpoint.pitch"
  answered late "every output looks a tick late"
  answered milliseconds 'its times are in ms, not in us; write time = "ms" in manifest.toml'
  answered cut "ends after tick" "it is cut off"
  answered gap "has no row for tick"
  answered unsorted "its rows are not in the order of time: row 1 is at"
  answered no-integrals "no column out/mc_att_ctrl_status.published" "list it under lacks there"
  answered other-names "The file also has vehicle_p_sp"
}

@test "the manifest declares units, names and what was not recorded" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer --mistake milliseconds
  sed -i "s/^time = .*/time = 'ms'/" vectors/manifest.toml
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 0 ]
  sed -i "s/^time = .*/time = 'hours'/" vectors/manifest.toml
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 2 ]
  has "vectors/manifest.toml:"
  has "\`hours\` is no unit of time; write s, ms or us"
  sed -i "s/^time = .*/time = 'us'/" vectors/manifest.toml

  answer --mistake no-integrals
  sed -i "s#^lacks = .*#lacks = ['mc_att_ctrl_status']#" vectors/manifest.toml
  run "$ATTEST" run --port recorded:vectors "${filter[@]}" --json report.json
  [ "$status" -eq 0 ]
  "$PYTHON" - "$SOURCE/harness/report/report.schema.json" <<'CHECK'
import json, sys
import jsonschema
report = json.load(open("report.json"))
jsonschema.Draft7Validator(json.load(open(sys.argv[1]))).validate(report)
assert report["port"]["lacks"] == ["mc_att_ctrl_status"], report["port"]
CHECK
  has "because: lacks mc_att_ctrl_status; "
  lacks "but it has"
  sed -i "s#^lacks = .*#lacks = ['mc_att_ctrl_statu']#" vectors/manifest.toml
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 2 ]
  has "vectors/manifest.toml:"
  has "did you mean \`mc_att_ctrl_status\`?"
}

@test "columns have any order and names, and others are ignored with a note" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer
  out=vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.csv
  # As pandas and MATLAB write it: a column of row numbers without a name, and names as identifiers.
  tr -d '\r' <$out | awk -F, -v OFS=, 'NR == 1 { gsub(/[^a-zA-Z0-9,]/, "_"); $1 = "timestamp" }
    { print (NR == 1 ? "" : NR - 2), $19, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14,
            $15, $16, $17, $18, $1, (NR == 1 ? "temperature" : 20) }' >reordered
  sed -i '1s/out_vehicle_rates_setpoint_roll/p_sp/' reordered
  mv reordered $out
  printf "\n[columns]\np_sp = 'out/vehicle_rates_setpoint.roll'\n" >>vectors/manifest.toml
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 0 ]
  has "note: $out: these columns are ignored: temperature"
}

@test "inputs as MAT files; a fixed step begins one period after zero" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  "$ATTEST" vectors mat --format mat "${filter[@]}" >/dev/null
  head -c 19 mat/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.mat | grep -q "MATLAB 5.0 MAT-file"
  run "$ATTEST" vectors xls --format xls "${filter[@]}"
  [ "$status" -eq 2 ]
  has "no format \`xls\`; there are csv, mat"

  "$ATTEST" vectors vectors --fixed-step 250 --group attitude --profile px4-v1.5.5 >/dev/null
  inputs=vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.csv
  [ "$(awk -F, 'NR == 2 { print $1 }' $inputs)" = 4000 ]
  answer
  run "$ATTEST" run --port recorded:vectors --group attitude --profile px4-v1.5.5
  [ "$status" -eq 0 ]
  has "fixed step of 250 Hz"
  run "$ATTEST" vectors vectors "${filter[@]}"
  [ "$status" -eq 2 ]
  has "is for a fixed step of 250 Hz; write these vectors to another folder"
}

@test "attest does not load libmatio until a MAT file needs it" {
  run ldd "$ATTEST"
  [ "$status" -eq 0 ]
  lacks matio
  lacks hdf5 # which libmatio uses
}

# as_mat CSV MISSING: writes the table as a MAT file next to it, as MATLAB does. The last variable
# has MISSING values less than its dimensions say.
as_mat() {
  "$PYTHON" - "$@" <<'MAT'
import csv, re, struct, sys

def element(kind, content):
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)

def variable(name, values, missing):
    shape = struct.pack("<ii", len(values), 1)
    values = values[: len(values) - missing]
    tags = element(6, struct.pack("<II", 6, 0)) + element(5, shape) + element(1, name.encode())
    return element(14, tags + element(9, struct.pack(f"<{len(values)}d", *values)))

header, *rows = csv.reader(open(sys.argv[1]))
with open(sys.argv[1].replace(".csv", ".mat"), "wb") as file:
    file.write(b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM")
    for i, name in enumerate(header):
        missing = int(sys.argv[2]) if i == len(header) - 1 else 0
        name = re.sub(r"\W+", "_", name)
        file.write(variable(name, [float(row[i]) for row in rows], missing))
MAT
}

@test "outputs in a MAT file are judged, and a variable that lacks a value is named" {
  filter=(--filter px4-v1.5.5/rates/p_alone@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer
  out=vectors/px4-v1.5.5/rates/p_alone/250hz.out
  as_mat $out.csv 0
  rows=$(($(wc -l <$out.csv) - 1))
  last=$(head -n 1 $out.csv | tr -d '\r' | sed 's/.*,//; s/[^a-zA-Z0-9_]/_/g')
  mv $out.csv kept.out.csv
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
  cp kept.out.csv $out.csv
  as_mat $out.csv 1
  rm $out.csv
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 1 ]
  has "$out.mat: the variable \`$last\` has $((rows - 1)) values, but its dimensions are $rows x 1"
}

@test "a damaged header and a link to nowhere are errors of the recording" {
  filter=(--filter px4-v1.5.5/rates/p_alone@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer
  out=vectors/px4-v1.5.5/rates/p_alone/250hz.out.csv
  sed '1s/,/,\x00/' $out >damaged
  mv damaged $out
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 1 ]
  has "protocol: $out:1:"
  has "a NUL byte in the name of a column"
  ln -sf nowhere $out
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 1 ]
  has "protocol: $out: cannot open the file"
}

@test "a folder that cannot be judged is an error before anything runs" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  refused() {
    run "$ATTEST" run --port recorded:vectors "${filter[@]}" --json report.json
    [ "$status" -eq 2 ]
    has "$1"
    [ ! -e report.json ]
  }
  refused "vectors: has no manifest.toml"
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  refused "vectors: has no outputs; write those of px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz"
  answer
  cp vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.csv{,.kept}
  cp vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.{csv,mat}
  refused "there is also"
  rm vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.mat
  sed -i "s/^\('px4-v1.5.5.*= '\)....../\1000000/" vectors/manifest.toml
  refused "the inputs of px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz are not those of this suite"
  filter=(--filter px4-v1.5.5/attitude/both_tilted@250hz)
  refused "vectors: has outputs of none of the 1 selected vectors"
  run "$ATTEST" time --port recorded:vectors
  [ "$status" -eq 2 ]
  has "this command must call the port"
}

# not_recorded NAME...: the manifest lists the outputs as lacking.
not_recorded() {
  local list
  list=$(printf "'%s', " "$@")
  sed -i "s#^lacks = .*#lacks = [${list%, }]#" vectors/manifest.toml
}

@test "a recording without a value is not judged, and a column that is not recorded is not read" {
  filter=(--filter px4-v1.5.5/rates/p_alone@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer
  out=vectors/px4-v1.5.5/rates/p_alone/250hz.out.csv
  mapfile -t all < <(head -n 1 $out | tr -d '\r' | tr , '\n' | grep ^out/)
  mapfile -t flags < <(printf '%s\n' "${all[@]}" | grep published)
  mapfile -t values < <(printf '%s\n' "${all[@]}" | grep -v published)
  for listed in all values; do
    declare -n names=$listed
    not_recorded "${names[@]}"
    run "$ATTEST" run --port recorded:vectors "${filter[@]}"
    [ "$status" -eq 2 ]
    has "NONE 0 vectors passed, 0 failed; 1 unsupported"
    has "no value is left to judge"
  done

  not_recorded "${flags[@]}"
  column=$(head -n 1 $out | tr , '\n' | grep -n published | head -n 1 | cut -d: -f1)
  awk -F, -v OFS=, -v column="$column" 'NR > 1 { $column = 0 } 1' $out >unpublished
  mv unpublished $out
  run "$ATTEST" run --port recorded:vectors "${filter[@]}"
  [ "$status" -eq 0 ]
  has "because: lacks ${flags[0]}, "
}

@test "recorded outputs are those of the parameters for which their inputs were written" {
  filter=(--filter px4-v1.5.5/rates/p_alone@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  answer
  run "$ATTEST" run --port recorded:vectors "${filter[@]}" --param MC_ROLLRATE_P=0.2
  [ "$status" -eq 2 ]
  has "--param: the outputs in vectors are for the parameters of the cases"

  run "$ATTEST" vectors vectors "${filter[@]}" --param MC_ROLLRATE_P=0.2
  [ "$status" -eq 2 ]
  has "is for the parameters of the cases; write these vectors to another folder"
  rm -r vectors
  "$ATTEST" vectors vectors "${filter[@]}" --param MC_ROLLRATE_P=0.2 >/dev/null
  answer
  for option in "" "--param MC_ROLLRATE_P=0.2"; do
    run "$ATTEST" run --port recorded:vectors "${filter[@]}" $option
    [ "$status" -eq 0 ]
    has "because: with MC_ROLLRATE_P=0.2; "
  done
}
