# The starters that have the two laws alone: the cases of both laws.

load common

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1 # the starter's folder stays as it is
}

starters="$(dirname "$STARTER")/.."
in_c="lib:$starters/c_law/attest_starter_c_law.so"
in_python="$SOURCE/controller/starters/python_law"

@test "the starter in C has the laws of v1.14 to v1.17, and the rate law of v1.18, to the bit" {
  run "$ATTEST" run --level exact --group attitude_law,rate_law --port "$in_c"
  [ "$status" -eq 0 ]
  has "PASS 174 of 249 vectors conform, 21 unsupported, 54 skip"
  has "the port makes no attitude law of profile px4-v1.18"
}

@test "the starter in Python has them to the bit, too" {
  # One profile: the law is the same in the others.
  run "$ATTEST" run --level exact --group attitude_law,rate_law --profile px4-v1.17 \
    --port "proc:$PYTHON $in_python/port.py"
  [ "$status" -eq 0 ]
  has "PASS 39 of 39 vectors conform"
  run "$ATTEST" smoke --port "proc:$PYTHON $in_python/port.py"
  [ "$status" -eq 0 ]
  lacks BAD
}

@test "a mistake in a law of theirs is found" {
  cp -r "$in_python" wrong
  sed -i 's/+ self.integral\[axis\]$/- self.integral[axis]/' wrong/law.py
  run cmp -s wrong/law.py "$in_python/law.py"
  [ "$status" -eq 1 ]
  run "$ATTEST" run --filter 'px4-v1.17/rate_law/integral' --port "proc:$PYTHON wrong/port.py"
  [ "$status" -eq 1 ]
  has "look first at the rate law"
}
