# Read by ctest when it starts, with PROGRAM, a GoogleTest program, and LABEL: makes the tests of the program its own.
# By default each test is one of ctest's. From the environment:
#   COPPICE_TEST_SUITES  where set, all tests of a suite, whatever their parameters, are one of ctest's, which says how
#                        many they are: in one process, which opens the device and makes each pipeline once
#   COPPICE_TEST_EXCEPT  a regular expression; tests whose names, such as Suite.Test, it fits are left out
cmake_policy(VERSION 3.25)
if(NOT EXISTS ${PROGRAM})
  add_test(${LABEL}_tests_not_built ${PROGRAM})
  return()
endif()
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE lines RESULT_VARIABLE status TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its tests: ${status}")
endif()
# Parameters stand as comments, in any characters.
string(REGEX REPLACE " *#[^\n]*" "" lines "${lines}")
string(REPLACE "\n" ";" lines "${lines}")

set(groups)
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+\\.)$")
    set(suite ${CMAKE_MATCH_1})
    # Instances of one suite are named PREFIX/SUITE.
    string(REGEX REPLACE "^([^/]*/)?([^/]*)\\.$" "\\2" group ${suite})
  elseif(line MATCHES "^  ([^ ]+)$")
    set(test ${suite}${CMAKE_MATCH_1})
    if(NOT "$ENV{COPPICE_TEST_EXCEPT}" STREQUAL "" AND test MATCHES "$ENV{COPPICE_TEST_EXCEPT}")
      continue()
    endif()
    if("$ENV{COPPICE_TEST_SUITES}" STREQUAL "")
      set(group ${test})
    endif()
    if(NOT group IN_LIST groups)
      list(APPEND groups ${group})
      set(tests_of_${group}) # the other program may have a suite of this name
    endif()
    list(APPEND tests_of_${group} ${test})
  endif()
endforeach()

foreach(group IN LISTS groups)
  set(tests ${tests_of_${group}})
  set(name ${group})
  set(skipped SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
  if(NOT "$ENV{COPPICE_TEST_SUITES}" STREQUAL "")
    list(LENGTH tests count)
    set(name "${group} (${count} tests)")
    string(REPLACE "(1 tests)" "(1 test)" name ${name})
    set(skipped) # of a suite some may be, beside others that fail
  endif()
  list(FIND LONGEST ${group} place)
  if(place EQUAL -1)
    set(cost 0)
  else()
    math(EXPR cost "90 - ${place}") # where ctest has not measured it yet
  endif()
  list(JOIN tests ":" filter)
  add_test(${name} ${PROGRAM} --gtest_filter=${filter})
  set_tests_properties(${name} PROPERTIES LABELS ${LABEL} COST ${cost} ${skipped})
endforeach()
