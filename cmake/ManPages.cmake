# Writes manual pages from what a program says of itself, compressed as Debian wants them:
#   cmake -DPROGRAM=build/release/bin/searchlight -DSUMMARY=... -DVERSION=0.1.0 -DFOLDER=man -P cmake/ManPages.cmake
# A program with commands has each of them in its page.
cmake_path(GET PROGRAM FILENAME name)

function(help_of result)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE text RESULT_VARIABLE failed
    COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "${PROGRAM}" "${name}" text "${text}")
  # Whatever roff would take for its own.
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
  string(STRIP "${text}" text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

help_of(text)
string(TOUPPER ${name} title)
set(page ".TH ${title} 1 \"\" \"Searchlight ${VERSION}\" \"User commands\"
.SH NAME
${name} \\- ${SUMMARY}
.SH DESCRIPTION
.nf
${text}
.fi
")

# "  plot      One of: pencil, error" is two commands of two words.
if(text MATCHES "\nSubcommands:\n(.*)$")
  string(APPEND page ".SH COMMANDS\n")
  string(REPLACE ";" "," rest "${CMAKE_MATCH_1}")
  string(REPLACE "\n" ";" lines "${rest}")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^  ([a-z]+) +(.*)$")
      break()
    endif()
    set(command ${CMAKE_MATCH_1})
    set(kinds "")
    if(CMAKE_MATCH_2 MATCHES "^One of: (.*)$")
      string(REPLACE ", " ";" kinds "${CMAKE_MATCH_1}")
    else()
      set(kinds "-")
    endif()
    foreach(kind IN LISTS kinds)
      set(words ${command})
      if(NOT kind STREQUAL "-")
        list(APPEND words ${kind})
      endif()
      help_of(text ${words})
      list(JOIN words " " heading)
      string(APPEND page ".SS ${name} ${heading}\n.nf\n${text}\n.fi\n")
    endforeach()
  endforeach()
endif()

string(APPEND page ".SH SEE ALSO\n/usr/share/doc/searchlight\n")
file(WRITE ${FOLDER}/${name}.1 "${page}")
execute_process(COMMAND gzip -9nf ${FOLDER}/${name}.1 COMMAND_ERROR_IS_FATAL ANY)
