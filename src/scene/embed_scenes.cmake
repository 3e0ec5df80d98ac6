# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a header with the text of every scene in SCENES (a list of .toml files).
set(entries "")
foreach(file ${SCENES})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND entries "        {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by the build from scenes/*.toml.
#pragma once

#include <vector>

#include \"scene/builtin.h\"

namespace gischt {

inline const std::vector<BuiltinScene>& builtin_texts() {
    static const std::vector<BuiltinScene> texts{
${entries}    };
    return texts;
}

}  // namespace gischt
")
