load common

@test "every fault that can be told from the law is caught, by a case of its own group" {
  run "$ATTEST" faults
  [ "$status" -eq 0 ]
  has "are caught (100.0%)"
  lacks "survives"
}
