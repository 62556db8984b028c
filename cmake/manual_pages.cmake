# cmake -DS7200=COMMAND -DINTO=FOLDER -P manual_pages.cmake: writes the manual page of the command and of each of its verbs,
# compressed as Debian wants it. The names and the pages are the command's own.
file(REMOVE_RECURSE ${INTO})
file(MAKE_DIRECTORY ${INTO})

function(write_page name)
  execute_process(COMMAND ${S7200} manual ${ARGN} OUTPUT_FILE ${INTO}/${name}.1 COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9n ${INTO}/${name}.1 COMMAND_ERROR_IS_FATAL ANY)
endfunction()

execute_process(COMMAND ${S7200} complete -- "" OUTPUT_VARIABLE verbs COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" verbs "${verbs}")
write_page(s7200)
foreach(verb IN LISTS verbs)
  string(REGEX REPLACE "\t.*" "" verb "${verb}")
  write_page(s7200-${verb} ${verb})
endforeach()
