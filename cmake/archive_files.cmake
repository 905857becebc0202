# Run when an archive is made on Debian: adds the licences of all that is in it, and an SBOM by SPDX 2.3, both below
# ${documents}. A notice names what no package of Debian brought; other systems' package managers are not asked.
# Ref: https://spdx.github.io/spdx-spec/v2.3/
set(root $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
find_program(DPKG_QUERY dpkg-query)
if(NOT DPKG_QUERY)
    message("-- This system has no dpkg: the archive lacks the licences of its libraries, and an SBOM.")
    return()
endif()

# query(VARIABLE ARGUMENT...): what dpkg-query prints, without the line's end; nothing if it knows no such package.
function(query variable)
    execute_process(COMMAND ${DPKG_QUERY} ${ARGN} OUTPUT_VARIABLE text ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(${variable} "${text}" PARENT_SCOPE)
endfunction()

macro(lack what)
    message("-- ${what} is of no package of Debian: the archive lacks its licence, and the SBOM its name.")
endmacro()

string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC)
set(sbom "SPDXVersion: SPDX-2.3
DataLicense: CC0-1.0
SPDXID: SPDXRef-DOCUMENT
DocumentName: ${name}
DocumentNamespace: urn:candela:sbom:${name}
Creator: Tool: candela-archive_files.cmake
Created: ${created}

PackageName: candela
SPDXID: SPDXRef-candela
PackageVersion: ${version}
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: false
PackageLicenseConcluded: MIT
PackageLicenseDeclared: MIT
PackageCopyrightText: <text>Copyright (c) 2026 the candela authors</text>
Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-candela
")

# describe(PACKAGE VERSION ARCHITECTURE SOURCE RELATIONSHIP): adds to the SBOM.
function(describe package version architecture source relationship)
    string(REGEX REPLACE "[^A-Za-z0-9.-]" "-" id ${package})
    string(REPLACE "+" "%2B" encoded ${version})
    string(APPEND sbom "
PackageName: ${package}
SPDXID: SPDXRef-${id}
PackageVersion: ${version}
PackageSupplier: Organization: Debian
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: false
PackageSourceInfo: built from Debian's source package ${source}
PackageLicenseConcluded: NOASSERTION
PackageLicenseDeclared: NOASSERTION
PackageLicenseComments: <text>See licenses/${package}.txt.</text>
PackageCopyrightText: NOASSERTION
ExternalRef: PACKAGE-MANAGER purl pkg:deb/debian/${package}@${encoded}?arch=${architecture}
Relationship: SPDXRef-candela ${relationship} SPDXRef-${id}
")
    set(sbom "${sbom}" PARENT_SCOPE)
endfunction()

# add(PACKAGE RELATIONSHIP): a package of Debian that candela links so.
function(add package relationship)
    query(version -f "\${Version}" -W ${package})
    query(source -f "\${source:Package}" -W ${package})
    query(architecture -f "\${Architecture}" -W ${package})
    if(NOT version)
        lack(${package})
        return()
    endif()
    string(REGEX REPLACE ":.*" "" package ${package})
    file(COPY_FILE /usr/share/doc/${package}/copyright ${root}/${documents}/licenses/${package}.txt)
    describe(${package} ${version} ${architecture} ${source} ${relationship})
    set(sbom "${sbom}" PARENT_SCOPE)
endfunction()

# Of the libraries that the archive brings.
file(GLOB libraries ${root}/${library_folder}/*.so*)
set(packages)
foreach(library IN LISTS libraries)
    get_filename_component(library ${library} NAME)
    query(found -S */${architecture}/${library})
    string(REGEX MATCH "^[^:, ]+(:[^:, ]+)?" package "${found}")
    if(package)
        list(APPEND packages ${package})
    else()
        lack(${library})
    endif()
endforeach()
list(REMOVE_DUPLICATES packages)
list(SORT packages)
file(MAKE_DIRECTORY ${root}/${documents}/licenses)
foreach(package IN LISTS packages)
    add(${package} DYNAMIC_LINK)
endforeach()
foreach(package IN ITEMS libcli11-dev libglm-dev libstb-dev libvulkan-volk-dev nlohmann-json3-dev)  # Headers alone.
    add(${package} STATIC_LINK)
endforeach()
# What a portable program has inside: packages of Debian, and what was built from Debian's sources: NAME VERSION in each
# line.
if(built_from_source)
    set(packages libdraco-dev libjpeg62-turbo-dev libpng-dev libstdc++-12-dev libwebp-dev zlib1g-dev)
    if(windows)
        set(packages gcc-mingw-w64-x86-64-posix-runtime libz-mingw-w64-dev mingw-w64-x86-64-dev)
    endif()
    foreach(package IN LISTS packages)
        add(${package} STATIC_LINK)
    endforeach()
    file(STRINGS ${built_from_source}/versions sources)
    foreach(source IN LISTS sources)
        separate_arguments(source)
        list(GET source 0 package)
        list(GET source 1 version)
        file(COPY_FILE ${built_from_source}/${package}.txt ${root}/${documents}/licenses/${package}.txt)
        describe(${package} ${version} source ${package} STATIC_LINK)
    endforeach()
endif()
# Which is of no package of Debian (cmake/basisu.sh).
if(basisu)
    file(COPY_FILE ${basisu}/copyright ${root}/${documents}/licenses/basisu.txt)
    string(APPEND sbom "
PackageName: basisu
SPDXID: SPDXRef-basisu
PackageVersion: ${basisu_version}
PackageSupplier: Organization: Binomial LLC
PackageDownloadLocation: git+https://github.com/BinomialLLC/basis_universal@${basisu_tag}
FilesAnalyzed: false
PackageLicenseConcluded: Apache-2.0 AND BSD-3-Clause
PackageLicenseDeclared: Apache-2.0 AND BSD-3-Clause
PackageLicenseComments: <text>See licenses/basisu.txt.</text>
PackageCopyrightText: NOASSERTION
Relationship: SPDXRef-candela STATIC_LINK SPDXRef-basisu
")
endif()
file(WRITE ${root}/${documents}/sbom.spdx "${sbom}")
