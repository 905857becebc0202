# Run when a package of Debian is made: the program ${candela} writes its manual and completions below ${share}. What
# changed in which ${version} is in the project's own form of a change log; Debian's names it, and ${contact}.
file(REMOVE_RECURSE ${share})
file(MAKE_DIRECTORY ${share}/man/man1 ${share}/doc/candela)

execute_process(COMMAND ${candela} manual -o ${share}/man/man1 COMMAND_ERROR_IS_FATAL ANY)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${share}/doc/candela/changelog
    "candela (${version}) unstable; urgency=medium\n\n  * CHANGELOG.md says what changed.\n\n -- ${contact}  ${date}\n")
file(GLOB documents ${share}/man/man1/* ${share}/doc/candela/changelog)
execute_process(COMMAND gzip -9n ${documents} COMMAND_ERROR_IS_FATAL ANY)

foreach(place IN ITEMS bash:bash-completion/completions/candela zsh:zsh/vendor-completions/_candela
        fish:fish/vendor_completions.d/candela.fish)
    string(REPLACE ":" ";" place ${place})
    list(POP_FRONT place shell)
    execute_process(COMMAND ${candela} completion ${shell} OUTPUT_VARIABLE script COMMAND_ERROR_IS_FATAL ANY)
    file(WRITE ${share}/${place} "${script}")
endforeach()

# The run path is for archives.
file(RPATH_REMOVE FILE $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/bin/candela)
