# State that shows only after many steps or instances, or in several instances at once
# (tests/ports/hostile/state.c).
load common

# all_fail CASES PORT...: the wrong ports of the controller and of the cascade fail in all vectors.
all_fail() {
  local port law
  for port in "${@:2}"; do
    for law in "" _cascade; do
      run "$ATTEST" run --port "lib:$PORTS/hostile_state_$port$law.so" --no-diagnose \
        --filter "$1@250hz"
      echo "$port$law"
      [[ $status -eq 1 && $output =~ FAIL\ (2\ of\ 2|10\ of\ 10)\ vectors\ failed,\ 0\  ]] || {
        echo "exit $status: $output"
        return 1
      }
    done
  done
}

@test "wrong from step 65,536 on" {
  all_fail 'timing/*steps_beyond_16_bits' starts_again all_steps
}

@test "wrong from the 23rd instance on, or with the state of an earlier instance" {
  all_fail 'instances/*after_many' from_instance_23 used_slot
}

@test "an instance takes the place of one that exists" {
  all_fail 'instances/*among_many' living_slot
}

@test "a version of the law that all instances share" {
  all_fail 'instances/*other_profiles_alternately' last_profile first_profile
}

@test "intermediate results that two threads share" {
  all_fail 'instances/*on_two_threads' shared_inputs shared_outputs
}

# As on a busy virtual machine.
@test "the same if timers are 4 ms late" {
  cat >timers.c <<'C'
#include <dlfcn.h>
#include <time.h>
typedef int set_timer(timer_t, int, const struct itimerspec*, struct itimerspec*);
int timer_settime(timer_t timer, int flags, const struct itimerspec* set, struct itimerspec* old) {
  const struct itimerspec late = {{0, 0}, {0, set->it_value.tv_nsec + 4000000}};
  return ((set_timer*)dlsym(RTLD_NEXT, "timer_settime"))(timer, flags, &late, old);
}
C
  cc -D_GNU_SOURCE -shared -fPIC -o timers.so timers.c
  export LD_PRELOAD="$PWD/timers.so"
  all_fail 'instances/*on_two_threads' shared_inputs shared_outputs
}

@test "a shared variable that has the absolute value of an input" {
  for port in shared_size shared_size_cascade; do
    run "$ATTEST" run --port "lib:$PORTS/hostile_state_$port.so" --no-diagnose --verbose \
      --filter 'instances/*'
    [ "$status" -eq 1 ]
    has "two_together"
  done
}

# reproduced COUNT: each of the COUNT commands in junit.xml fails too.
reproduced() {
  python3 - >commands <<'COMMANDS'
import re, xml.etree.ElementTree
text = "\n".join(xml.etree.ElementTree.parse("junit.xml").getroot().itertext())
print("\n".join(re.findall("reproduce: attest (.*)", text)))
COMMANDS
  [ "$(wc -l <commands)" -eq "$1" ]
  while read -r command; do
    echo "$command"
    run bash -c "\"$ATTEST\" $command --no-diagnose </dev/null"
    [ "$status" -eq 1 ]
  done <commands
}

@test "a failure that depends on earlier vectors names them, and its command fails too" {
  run "$ATTEST" run --port "lib:$PORTS/hostile_state_from_instance_5.so" --no-diagnose \
    --filter 'rates/ff_alone@*' --profile px4-v1.5.5 --json report.json --junit junit.xml
  [ "$status" -eq 1 ]
  has "FAIL 2 of 11 vectors failed, 9 passed"
  has "it passes alone, in a new process of the port"
  python3 - <<'CHECK'
import json
failed = [r for r in json.load(open("report.json"))["results"] if r["verdict"] == "fail"]
assert [r["rate"] for r in failed] == ["400", "2000"], failed
after = [[i.partition("@")[2] for i in r["after"]] for r in failed]
assert after[0] == ["50hz", "100hz", "250hz", "333hz"], after
assert after[1] == ["400hz", "500hz", "800hz", "1000hz"], after
CHECK
  reproduced 2
  run "$ATTEST" run --port "lib:$PORTS/hostile_state_from_instance_5.so" --no-diagnose \
    --rerun-failed report.json
  [ "$status" -eq 1 ]
}

@test "vectors that are not run after a timeout name it" {
  cp -r "$SOURCE/controller/starters/c" hangs
  local loop='for (volatile int i = 0; dt > 0.0035f \&\& dt < 0.0045f;) i = 0;'
  sed -i "s/^  float dt = .*/&\n  $loop/" hangs/unit.c
  cc -O2 -std=c11 -ffp-contract=off -fPIC -shared -I"$SOURCE/controller" -o hangs.so hangs/*.c -lm
  run "$ATTEST" run --port lib:./hangs.so --filter 'rates/ff_alone@*' --profile px4-v1.5.5 \
    --timeout 0.5 --no-diagnose --junit junit.xml
  [ "$status" -eq 1 ]
  has "FAIL 9 of 11 vectors failed (9 timeout), 2 passed"
  reproduced 9
  run "$ATTEST" run --port lib:./hangs.so --filter 'rates/ff_alone@400hz' --profile px4-v1.5.5
  [ "$status" -eq 0 ]
}
