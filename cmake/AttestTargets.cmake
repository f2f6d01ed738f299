# Functions and flags for all targets of the project: one static library a folder, sources listed
# by hand, PUBLIC/PRIVATE link visibility as the dependency rule.

add_library(attest_flags INTERFACE)
target_compile_features(attest_flags INTERFACE cxx_std_20 c_std_11)
# The law is defined in IEEE binary32 without contraction (a*b+c rounds twice); a fused multiply-add
# changes bits. The harness computes stimuli under the same rule, so that gcc and clang agree to the
# bit on x86-64.
target_compile_options(attest_flags INTERFACE -ffp-contract=off -fno-math-errno)
target_include_directories(attest_flags INTERFACE ${PROJECT_SOURCE_DIR})

add_library(attest_warnings INTERFACE)
target_compile_options(
  attest_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                            $<$<BOOL:${ATTEST_WERROR}>:-Werror>
                            # False alarms of gcc 12 about std::string (gcc bug 105651).
                            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# The presets ci and asan build from nothing, and compile the sources of a folder as one or two (a
# unity build), because most sources take less time to compile than the headers that they include.
# The preset dev compiles each source separately, so that a missing include is found.
# In a unity build gcc treats sources as headers, where -Wsubobject-linkage reports mistakes.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(attest_warnings
                         INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()

# Half of the compile time is optimisation, so it depends on how long a library runs.
# RUNS_SELDOM: -O1 in a release; the whole suite takes as long as with -O3, within 2%.
# TESTED_BRIEFLY: -O0 with sanitizers (Debug), for what takes little of the tests' time. Not in the
# preset fuzz, which has no tests: there the same code takes most of the time.
set(ATTEST_RUNS_SELDOM $<$<CONFIG:Release>:-O1>)
set(ATTEST_TESTED_BRIEFLY $<$<AND:$<CONFIG:Debug>,$<BOOL:${ATTEST_TESTS}>>:-O0>)

# attest_library(NAME [RUNS_SELDOM] [TESTED_BRIEFLY] SOURCES a.cpp ... [PUBLIC target ...]
# [PRIVATE target ...])
function(attest_library name)
  cmake_parse_arguments(ARG "RUNS_SELDOM;TESTED_BRIEFLY" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  foreach(often RUNS_SELDOM TESTED_BRIEFLY)
    if(ARG_${often})
      target_compile_options(${name} PRIVATE ${ATTEST_${often}})
    endif()
  endforeach()
  target_link_libraries(${name} PUBLIC attest_flags ${ARG_PUBLIC} PRIVATE attest_warnings
                                                                          ${ARG_PRIVATE})
endfunction()

# attest_embed(SOURCE NAME=FILE ...): the source includes these files (harness/core/embed.hpp).
# ATTEST_NAME is the path of a file in it.
function(attest_embed source)
  foreach(entry IN LISTS ARGN)
    string(REGEX MATCH "^([^=]+)=(.+)$" entry ${entry})
    list(APPEND definitions "ATTEST_${CMAKE_MATCH_1}=\"${CMAKE_MATCH_2}\"")
    list(APPEND files ${CMAKE_MATCH_2})
  endforeach()
  set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS "${definitions}"
                                                   OBJECT_DEPENDS "${files}")
endfunction()

# Time limits [s]: tens of times the duration of the slowest test with sanitizers on two busy cores.
# So a test that hangs fails, and a slow machine does not cause failures.
set(ATTEST_COMMAND_TEST_TIMEOUT 1800)
set(ATTEST_LONG_TEST_TIMEOUT 3600)

# Not optimised: a test mostly runs once per compilation. In the preset asan (Debug), the code under
# test is checked for undefined behaviour and its tests are not, so they compile sooner.
set(ATTEST_TEST_OPTIONS -O0 $<$<CONFIG:Debug>:-fno-sanitize=undefined>)

# attest_unit_tests(NAME SOURCES a.cpp ... LINK target ... [LABEL label]): one GoogleTest program a
# folder. It is one test of CTest, because with sanitizers the start of a process takes longer than
# most cases. `NAME --gtest_filter=CASE` runs one case. Without ATTEST_UNIT_TESTS the program is
# built on request only, and is no test.
function(attest_unit_tests name)
  cmake_parse_arguments(ARG "" "LABEL" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE attest_flags attest_warnings attest_property_seed
                                        ${ARG_LINK} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE ATTEST_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE ${ATTEST_TEST_OPTIONS})
  # Smaller than in the rest: helpers of tests often have the same name, and the headers that take
  # long are precompiled.
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 8)
  get_target_property(sources ${name} SOURCES)
  if(NOT sources MATCHES "\\.c(;|$)") # the precompiled headers are C++
    target_precompile_headers(${name} REUSE_FROM attest_test_headers)
  endif()
  if(NOT ATTEST_UNIT_TESTS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ATTEST_COMMAND_TEST_TIMEOUT})
  if(ARG_LABEL)
    set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL})
  endif()
endfunction()

# attest_test_defaults(): applies to every test that the folder adds by add_test(), before or after
# this call. The test has the default time limit unless it sets its own, and python3 is the
# interpreter for which the packages of debian/control are installed (ATTEST_TEST_PATH).
function(attest_test_defaults)
  cmake_language(DEFER CALL attest_set_test_defaults)
endfunction()

function(attest_set_test_defaults)
  get_property(tests DIRECTORY PROPERTY TESTS)
  foreach(test IN LISTS tests)
    get_test_property(${test} TIMEOUT limit)
    if(NOT limit)
      set_tests_properties(${test} PROPERTIES TIMEOUT ${ATTEST_COMMAND_TEST_TIMEOUT})
    endif()
    set_tests_properties(${test} PROPERTIES ENVIRONMENT_MODIFICATION
                                            PATH=path_list_prepend:${ATTEST_TEST_PATH})
  endforeach()
endfunction()
