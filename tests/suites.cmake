# A test of ctest for each suite of a program of GoogleTest: to start such a program takes about as long as ten of its tests.
# Included, it brings add_suites(TARGET); as a script, after the program is linked, it writes the list that ctest reads.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(add_suites target)
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${list} VERBATIM
      COMMAND ${CMAKE_COMMAND} -D NAME=${target} -D PROGRAM=$<TARGET_FILE:${target}> -D LIST=${list} -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
    if(NOT EXISTS ${list})
      file(WRITE ${list} "add_test(${target}_is_not_built ${target})\n")
    endif()
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${list})
  endfunction()
  return()
endif()

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\.[ \n]" suites "\n${listed}")  # what is below them begins with blanks
if(NOT suites)
  message(FATAL_ERROR "${PROGRAM} has no tests")
endif()
# A suite counts as skipped if nothing of it ran.
set(skipped [=["\\[  PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$"]=])
set(tests "")
foreach(suite ${suites})
  string(REGEX REPLACE "[^A-Za-z0-9_/]" "" suite ${suite})
  string(APPEND tests "add_test([=[${NAME}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                      "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES SKIP_REGULAR_EXPRESSION ${skipped})\n")
endforeach()
file(WRITE ${LIST} "${tests}")
