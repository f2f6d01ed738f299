load common

@test "every fault that can be told from the law is caught, by a case of its own group" {
  for profile in px4-v1.5.5 px4-v1.3.4; do
    run "$ATTEST" faults --profile "$profile"
    [ "$status" -eq 0 ]
    has "$profile: "
    has "are caught (100.0%)"
    lacks "survives"
  done
}
