# The portable package, made from the installed attest. `ci/package --portable` also tries it in
# bare systems. Set by CTest: INSTALLED (the installed attest), SOURCE (the tree), STARTER (the C
# starter).

setup_file() {
  XZ_OPT=-0 "$SOURCE/ci/portable" "$INSTALLED" "$BATS_FILE_TMPDIR/attest.tar.xz"
}

setup() {
  cd "$BATS_TEST_TMPDIR"
  unset LD_LIBRARY_PATH ATTEST_SUITE
  tar --extract --file "$BATS_FILE_TMPDIR/attest.tar.xz"
  package=$(echo "$PWD"/attest-*)
  mv "$package" "a folder"
  package="$PWD/a folder"
}

@test "the unpacked package judges a port, anywhere, with its own suite and libraries" {
  ln -s "$package/bin/attest" attest
  run ./attest run --port "lib:$STARTER" --group attitude --rate 250
  [ "$status" -eq 0 ]
  [[ $output == *"suite "* && $output != *"custom suite"* ]]
  ./attest sim hover --out flight.mat --quiet # loads libmatio
  ./attest new-port mine --lang c --quiet
  [ -x mine/check ]
}

@test "it has the licenses and versions of its libraries" {
  cd "$package/share/doc/attest/licenses"
  for package in libmujoco2.2.2 libfmt9 libmatio11 libstdc++6 libcli11-dev nlohmann-json3-dev; do
    [ -s $package ]
    grep -q "^$package [0-9]" PACKAGES
  done
  [ -s common-licenses/GPL-3 ]
  grep -q "glibc 2\.[0-9]* or newer" ../../../../README
}

@test "a library that the package lacks is found by the trial" {
  rm "$package"/lib/attest/libhdf5*
  run "$SOURCE/ci/package-try" "$package"
  [ "$status" -eq 1 ]
  [[ $output == *"libraries that are not in the package:"*libhdf5* ]]
}

@test "libstdc++ is that of the system, and that of the package where the system has none" {
  used() { LD_TRACE_LOADED_OBJECTS=1 "$package/bin/attest" | sed -n 's/.*libstdc.* => //p'; }
  [[ $(used) == /lib/* || $(used) == /usr/lib* ]]
  # This path has no folder of the system.
  # shellcheck disable=SC2016 # the dynamic linker expands it
  patchelf --force-rpath --set-rpath '$ORIGIN/../lib/attest:$ORIGIN/../lib/attest/compiler' \
    "$package/bin/attest"
  [[ $(used) == "$package"/* ]]
}
