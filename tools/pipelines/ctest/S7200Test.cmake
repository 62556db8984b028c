# Scenarios of s7200 as tests of CTest:
#   include(S7200Test)
#   s7200_add_scenarios(pump FILES scenarios/start.yaml scenarios/alarm.yaml OPTIONS --with plant.yaml)
# adds pump.start and pump.alarm. Paths, in OPTIONS too, are from the folder of the CMakeLists.txt. Each test writes its results as
# JUnit XML into the build folder: pump.start.xml and pump.alarm.xml.
find_program(S7200_COMMAND s7200 DOC "The command s7200, which runs scenarios")
if(NOT S7200_COMMAND)
  message(FATAL_ERROR "s7200 is not on PATH. Install it, or set S7200_COMMAND to where it is.")
endif()

function(s7200_add_scenarios prefix)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FILES;OPTIONS")
  if(NOT arg_FILES OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "s7200_add_scenarios wants PREFIX FILES file... [OPTIONS word...]; got: ${ARGV}")
  endif()
  foreach(file IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "s7200_add_scenarios: there is no scenario ${file}")
    endif()
    cmake_path(GET file STEM LAST_ONLY name)
    add_test(NAME ${prefix}.${name}
      COMMAND ${S7200_COMMAND} test ${arg_OPTIONS} ${file} --junit ${CMAKE_CURRENT_BINARY_DIR}/${prefix}.${name}.xml
      WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    set_tests_properties(${prefix}.${name} PROPERTIES REQUIRED_FILES ${file})
  endforeach()
endfunction()
