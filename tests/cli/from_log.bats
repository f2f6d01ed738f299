load common

# Half a second of a flight, in the suite ./ours.
suite_of_log() {
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  "$ATTEST" vectors ours --from-log gust.ulg --from 1 --to 1.5 >out.txt 2>/dev/null
}
from_log=ours/cases/px4-v1.5.5/from_log/gust_from_1s_to_1_5s.toml

@test "a stretch of a log becomes a case that judges ports at all rates" {
  suite_of_log
  grep -q "$from_log: 0.5 s, 125 samples of control_state" out.txt
  grep -q 'attest --suite ours bless --group from_log --yes --reason' out.txt
  "$ATTEST" --suite ours bless --group from_log --yes --reason "a flight"
  run "$ATTEST" --suite ours run --group from_log
  [ "$status" -eq 0 ]
  has "11 of 11 vectors conform"
  has "custom suite"
  run "$ATTEST" --suite ours run --group from_log --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "FAIL 11 failed"
}

@test "a case of a log overwrites no file, and is in no released suite" {
  suite_of_log
  before=$(sha256sum $from_log)
  echo ../other >ours/BASE
  run "$ATTEST" vectors ours --from-log gust.ulg --from 1 --to 1.5
  [ "$status" -eq 2 ]
  has "$from_log: exists, and is not overwritten"
  [ "$(sha256sum $from_log)" = "$before" ]
  [ "$(cat ours/BASE)" = ../other ]
  run "$ATTEST" vectors "$SOURCE" --from-log gust.ulg
  [ "$status" -eq 2 ]
  has "is a folder of the suite"
}

@test "a stretch that the log does not have is an error, and no folder is made" {
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  for wrong in "--from 9" "--to 9" "--from 2 --to 1" "--from 1 --to 1.001" "--profile px4-v1.5" \
    "--group tpa" "--rate 250"; do
    run "$ATTEST" vectors ours --from-log gust.ulg $wrong
    [ "$status" -eq 2 ]
    [ ! -e ours ]
  done
  run "$ATTEST" vectors ours --from-log gust.ulg --from 9
  has "gust.ulg: the stretch is beyond the log, whose samples of control_state are from 0 to 4 s"
  run "$ATTEST" vectors ours --from 1
  [ "$status" -eq 2 ]
  has "--from-log"
}
