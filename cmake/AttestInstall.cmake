# `cmake --install` installs for port authors: the attest binary with its manual pages and the
# completion for shells, the ABI headers, an archive of the suite (cases, goldens, models), the
# starters, the schemas of the reports, a library of the elementary functions, and the CMake package
# `attest` with
#
#     attest::unit     the ABI headers, for the port to link (C or C++)
#     attest::math     the elementary functions of attest_math.h, for the port to link
#     attest::attest   the binary
#     attest_add_tests(TARGET port)   a test of CTest for each group of the suite
include(CMakePackageConfigHelpers)

set(ATTEST_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/attest)
set(ATTEST_INSTALL_DATADIR ${CMAKE_INSTALL_DATADIR}/attest)

install(TARGETS attest_unit EXPORT attestTargets)
install(TARGETS attest_elementary EXPORT attestTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS attest EXPORT attestTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES controller/attest_unit.h controller/attest_actuation.h controller/attest_cascade.h
              controller/attest_law.h controller/attest_math.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# The suite has 1,700 files, most of them small: 40 MB on disk, and 10 MB as an archive.
set(packed_suite ${PROJECT_BINARY_DIR}/suite.zip)
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:attest_pack_suite>\"
        \"${PROJECT_SOURCE_DIR}\" \"${packed_suite}\" COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${packed_suite} DESTINATION ${ATTEST_INSTALL_DATADIR})
install(CODE "file(REMOVE \"${packed_suite}\")")  # a port that runs later must not find it
# Excludes the results of builds in the source tree.
install(
  DIRECTORY controller/starters
  DESTINATION ${ATTEST_INSTALL_DATADIR}
  USE_SOURCE_PERMISSIONS
  REGEX "/(build|target|__pycache__)$" EXCLUDE)
# For `attest new-port`.
install(FILES controller/attest_unit.h controller/attest_actuation.h controller/attest_cascade.h
              controller/attest_law.h controller/attest_math.h
        DESTINATION ${ATTEST_INSTALL_DATADIR}/include)
install(FILES ci/examples/github-action.yml ci/examples/github-actions.yml
              ci/examples/github-shards.yml ci/examples/gitlab-ci.yml ci/examples/gitlab-shards.yml
        DESTINATION ${ATTEST_INSTALL_DATADIR}/ci)
install(PROGRAMS ci/examples/install-attest DESTINATION ${ATTEST_INSTALL_DATADIR}/ci)
# Programs that read the JSON reports validate them with these schemas.
install(FILES harness/report/report.schema.json harness/report/stress.schema.json
        DESTINATION ${ATTEST_INSTALL_DATADIR}/schemas)

# The documents and what they link to, except sources of attest, in the folders of the source tree.
set(documents
    ARCHITECTURE.md
    CHANGELOG.md
    LICENSE
    README.md
    benchmarks/RESULTS.md
    cases/CORE
    cases/README.md
    ci/examples/Dockerfile
    ci/examples/github-action.yml
    ci/examples/github-actions.yml
    ci/examples/github-shards.yml
    ci/examples/gitlab-ci.yml
    ci/examples/gitlab-shards.yml
    ci/examples/install-attest
    controller/attest_actuation.h
    controller/attest_cascade.h
    controller/attest_law.h
    controller/attest_math.h
    controller/attest_unit.h
    controller/starters/c_program/README.md
    controller/starters/cortex_m/README.md
    controller/starters/serial_board/README.md
    controller/starters/simulink/README.md
    docs/flights.md
    docs/hunt.md
    docs/levels.md
    docs/own_law.md
    docs/ports.md
    docs/reports.md
    docs/sweeps.md
    docs/timing.md
    docs/traces.md
    docs/verdicts.md
    golden/README.md
    harness/casefile/SCHEMA.md
    harness/port/PROTOCOL.md
    harness/report/report.schema.json
    harness/report/stress.schema.json
    models/README.md
    tests/QUALITY.md)
foreach(document IN LISTS documents)
  get_filename_component(folder ${document} DIRECTORY)
  install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()

# harness/cli makes the manual pages and the completions.
set(help ${PROJECT_BINARY_DIR}/help)
install(DIRECTORY ${help}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${help}/attest.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME attest)
install(FILES ${help}/_attest DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)

install(EXPORT attestTargets NAMESPACE attest:: DESTINATION ${ATTEST_INSTALL_CMAKEDIR})
configure_package_config_file(cmake/attestConfig.cmake.in attestConfig.cmake
                              INSTALL_DESTINATION ${ATTEST_INSTALL_CMAKEDIR}
                              PATH_VARS ATTEST_INSTALL_DATADIR)
# ARCH_INDEPENDENT: a port that is cross-compiled for another word size can use the header.
write_basic_package_version_file(attestConfigVersion.cmake COMPATIBILITY SameMajorVersion
                                 ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/attestConfig.cmake
              ${PROJECT_BINARY_DIR}/attestConfigVersion.cmake
        DESTINATION ${ATTEST_INSTALL_CMAKEDIR})
