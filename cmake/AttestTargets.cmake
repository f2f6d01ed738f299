# How every target of the project is made: one static library a folder, sources listed by hand,
# PUBLIC/PRIVATE link visibility as the dependency rule.

add_library(attest_flags INTERFACE)
target_compile_features(attest_flags INTERFACE cxx_std_20 c_std_11)
# The law is defined in IEEE binary32 without contraction (a*b+c rounds twice); a compiler that
# fuses it changes bits. The harness computes stimuli under the same rule, so that gcc and clang
# agree to the bit on x86-64.
target_compile_options(attest_flags INTERFACE -ffp-contract=off -fno-math-errno)
target_include_directories(attest_flags INTERFACE ${PROJECT_SOURCE_DIR})

add_library(attest_warnings INTERFACE)
target_compile_options(
  attest_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                            $<$<BOOL:${ATTEST_WERROR}>:-Werror>
                            # False alarms of gcc 12 about std::string (gcc bug 105651).
                            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# What nearly every source reads takes longer to read than the source takes to compile. Tests
# always share it precompiled; the harness in builds from nothing, not in daily work, where a source
# that forgets an include is to be told.
option(ATTEST_PRECOMPILE "Precompile common headers for the harness: quicker from nothing" OFF)
# About std::string in precompiled headers gcc 12 raises these, which are false alarms.
if(ATTEST_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(attest_warnings INTERFACE -Wno-array-bounds -Wno-stringop-overflow)
endif()

# attest_headers(TARGET header ...): a target whose precompiled headers others reuse, which have its
# flags at least, and no source in C.
function(attest_headers name)
  set(headers <algorithm> <array> <filesystem> <functional> <map> <memory> <optional> <string>
              <string_view> <variant> <vector> <tl/expected.hpp> ${ARGN})
  target_precompile_headers(${name} PRIVATE ${headers})
endfunction()

function(attest_reuse_headers name from)
  get_target_property(sources ${name} SOURCES)
  if(NOT sources MATCHES "\\.c(;|$)")
    target_precompile_headers(${name} REUSE_FROM ${from})
  endif()
endfunction()

# attest_library(NAME SOURCES a.cpp ... [PUBLIC target ...] [PRIVATE target ...])
function(attest_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC attest_flags ${ARG_PUBLIC} PRIVATE attest_warnings
                                                                          ${ARG_PRIVATE})
  if(ATTEST_PRECOMPILE AND fmt::fmt IN_LIST ARG_PRIVATE)
    attest_reuse_headers(${name} attest_library_headers)
  endif()
endfunction()

# In seconds: tens of times what the slowest takes with sanitizers on two cores that do other things
# too. A test that hangs is to fail, a slow machine is not to.
set(ATTEST_UNIT_TEST_TIMEOUT 600)
set(ATTEST_COMMAND_TEST_TIMEOUT 1800)
set(ATTEST_LONG_TEST_TIMEOUT 3600)

# attest_test(NAME SOURCES a.cpp ... LINK target ... [LABEL label]): one GoogleTest program a
# folder.
function(attest_test name)
  cmake_parse_arguments(ARG "" "LABEL" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE attest_flags attest_warnings ${ARG_LINK} GTest::gmock
                                        GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE ATTEST_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # Tests run once for each time that they are compiled.
  target_compile_options(${name} PRIVATE -O0)
  attest_reuse_headers(${name} attest_test_headers)
  set(properties TIMEOUT ${ATTEST_UNIT_TEST_TIMEOUT})
  if(ARG_LABEL)
    list(APPEND properties LABELS ${ARG_LABEL})
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES ${properties})
endfunction()

# attest_time_limits(): every test that the folder adds by add_test(), before this call or after it,
# has a time limit: the default, if it sets none.
function(attest_time_limits)
  cmake_language(DEFER CALL attest_set_time_limits)
endfunction()

function(attest_set_time_limits)
  get_property(tests DIRECTORY PROPERTY TESTS)
  foreach(test IN LISTS tests)
    get_test_property(${test} TIMEOUT limit)
    if(NOT limit)
      set_tests_properties(${test} PROPERTIES TIMEOUT ${ATTEST_COMMAND_TEST_TIMEOUT})
    endif()
  endforeach()
endfunction()
