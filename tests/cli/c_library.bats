# Ports that call float functions of this machine's C library. On Debian 12 these are not always
# correctly rounded. Where they are, such a port passes, and the reports say nothing of them.
load common

# caller STARTER CALLS [SED]: builds ./STARTER.so, a starter in C that makes the calls, such as
# "asin acos". SED changes its law.
caller() {
  mkdir -p "$1"
  cp "$SOURCE/controller/starters/$1"/*.c "$SOURCE/controller/starters/$1"/*.h "$1/"
  for name in $2; do
    sed -Ei "s/\(float\)$name\((.*)\);/${name}f(\1);/; /${name}f\(/s/\(double\)//g" \
      "$1/elementary.h"
    grep -q "return ${name}f(x);\|return ${name}f(y, x);" "$1/elementary.h"
  done
  sed -i "${3:-}" "$1"/*.c
  cc -O2 -std=c11 -ffp-contract=off -fPIC -shared -I"$SOURCE/controller" -o "$1.so" "$1"/*.c -lm
}

in_cascade=(--profile px4-v1.16.0 --exclude '*/flight/*' --rate 250)
in_v1_5_5=(--profile px4-v1.5.5 --group attitude --group tailsitter --rate 250)

# conforms: the port of the last `run` does, because this C library rounds correctly. glibc 2.36 of
# Debian 12 does not.
conforms() {
  [ "$status" -eq 0 ] && ! grep -q '2\.36' <<<"$(ldd --version)" && lacks "libm-"
}

@test "a port fails because of the C library: the reports name the functions and the remedy" {
  caller c_cascade "sin cos asin acos atan2"
  run "$ATTEST" run "${in_cascade[@]}" --level exact --port lib:./c_cascade.so --json report.json \
    --junit report.xml --html report.html
  conforms && return
  [ "$status" -eq 1 ]
  has "it looks like:"
  [[ $output =~ \`libm-([a-z0-9-]+)\`:\ calls\ ([a-z0-9, ]+)\ of\ the\ C\ library ]]
  [ "${BASH_REMATCH[1]}" = "${BASH_REMATCH[2]//, /-}" ]
  has "link attest::math (with the starters: ATTEST_MATH=1), or judge at the level numeric"
  [[ $output =~ values\ in\ ([0-9]+)\ of\ ([0-9]+)\ failing ]]
  [ "${BASH_REMATCH[1]}" -eq "${BASH_REMATCH[2]}" ]
  for report in report.json report.xml report.html; do grep -q 'libm-' "$report"; done
}

@test "the C library is named for the smallest set of calls that explains all vectors" {
  caller c_cascade asin
  run "$ATTEST" run "${in_cascade[@]}" --level exact --port lib:./c_cascade.so
  conforms || has '`libm-asinf`: calls asinf of the C library, which on this machine is not always'
  caller c atan2
  run "$ATTEST" run "${in_v1_5_5[@]}" --level exact --port lib:./c.so
  conforms || has '`libm-atan2f`: calls atan2f of the C library'
}

@test "a single call of the C library is named by its place in the law" {
  caller c ""
  sed -i 's/angle = law_atan2(/angle = atan2f(/' c/attitude.c
  cc -O2 -std=c11 -ffp-contract=off -fPIC -shared -I"$SOURCE/controller" -o c.so c/*.c -lm
  run "$ATTEST" run "${in_v1_5_5[@]}" --level exact --port lib:./c.so
  conforms || has '`libm-atan2f@tilt_error`: calls atan2f of the C library where the law has'
}

@test "at the level numeric, a port that calls the C library passes" {
  caller c_cascade "sin cos asin acos atan2"
  run "$ATTEST" run "${in_cascade[@]}" --level numeric --port lib:./c_cascade.so
  [ "$status" -eq 0 ]
  lacks "libm-"
}

@test "a wrong port is not excused by the C library" {
  caller c_cascade "sin cos asin acos atan2" 's/e\.x \* 2\.0f/e.x * 2.01f/'
  for level in exact numeric; do
    run "$ATTEST" run "${in_cascade[@]}" --level $level --port lib:./c_cascade.so
    [ "$status" -eq 1 ]
    lacks "libm-"
  done
  for port in fault:cascade-quat-order-xyzw "lib:$PORTS/reference_double.so"; do
    run "$ATTEST" run "${in_cascade[@]}" --level exact --port "$port"
    echo "$port: $output"
    [ "$status" -eq 1 ]
    lacks "libm-"
  done
}

# Ports that were written without sight of the starters. Some sums of the second are in another
# order, so not all of its deviations have this cause.
@test "the report counts the failing vectors that the C library explains" {
  for style in cpp simulink; do
    run "$ATTEST" run --level exact --rate 250 --profile px4-v1.5.5 --group attitude --group tpa \
      --port "lib:$PORTS/right_${style}_style.so"
    echo "$style: $output"
    conforms && continue
    [ "$status" -eq 1 ]
    grep -q '2\.36' <<<"$(ldd --version)" || continue
    has '`libm-atan2f`: calls atan2f of the C library'
    [[ $output =~ values\ in\ ([0-9]+)\ of\ ([0-9]+)\ failing ]]
    local explained=${BASH_REMATCH[1]} failing=${BASH_REMATCH[2]}
    [ $((explained < failing)) -eq "$([ "$style" = simulink ] && echo 1 || echo 0)" ]
  done
}

@test "in a law alone the functions are named, too" {
  caller c_law "sin cos asin acos"
  run "$ATTEST" run --profile px4-v1.16.0 --group attitude_law --level exact --port lib:./c_law.so
  conforms && return
  [ "$status" -eq 1 ]
  has "libm-"
  has "link attest::math"
}
