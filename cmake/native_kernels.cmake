# SPDX-License-Identifier: Apache-2.0
# add_native_kernels(LIBRARY): the kernels compiled ahead of time for pthreads (kernels/native), one object a
# variant, and native_table.h, a table of them all. GCC knows no OpenCL C, so clang compiles them whatever
# builds the host.
option(MIRRORBALL_NATIVE "Compile kernels for pthreads; without them, pictures need an OpenCL device" ON)
if(MIRRORBALL_NATIVE)
    find_program(KERNEL_CLANG NAMES clang-19 clang-20 clang-18 clang-17 clang)
    if(NOT KERNEL_CLANG)
        message(FATAL_ERROR "no clang to compile the kernels with: install clang-19 (17 or later will do)")
    endif()
    execute_process(COMMAND ${KERNEL_CLANG} -dumpversion OUTPUT_VARIABLE KERNEL_CLANG_VERSION
        OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(KERNEL_CLANG_VERSION VERSION_LESS 17)
        message(FATAL_ERROR
            "clang ${KERNEL_CLANG_VERSION} is too old to compile the kernels: install clang-19")
    endif()
endif()

# The flags of every variant. The pictures' bits depend on -ffp-contract=off.
set(NATIVE_KERNEL_FLAGS -x cl -cl-std=CL1.2 -cl-no-stdinc -Xclang -cl-ext=+cl_khr_fp64
    -include ${CMAKE_SOURCE_DIR}/kernels/native/opencl_c.h -I${CMAKE_SOURCE_DIR}
    -O3 -ffp-contract=off -cl-fp32-correctly-rounded-divide-sqrt -fno-math-errno -fPIC
    -Wall -Wextra -Wno-unused-parameter -Wno-unused-function -Wno-psabi)
if(MIRRORBALL_WERROR)
    list(APPEND NATIVE_KERNEL_FLAGS -Werror)
endif()

# Under sanitizers the kernels of all features stand for all: they take long to compile.
set(NATIVE_SETS plain_4 plain mesh_4 mesh plain_edges mesh_edges all)
if(MIRRORBALL_SANITIZE)
    set(NATIVE_SETS all)
    set(NATIVE_FEWER_ISAS x86-64-v3)
    set(NATIVE_FEWER_WIDTHS 1)  # and that of a vector
    # The bits of numbers are added as integers that may wrap (kernels/power.cl).
    list(APPEND NATIVE_KERNEL_FLAGS -O1 -g1 -fsanitize=${SANITIZERS} -fno-sanitize-recover=all
        -fno-sanitize=signed-integer-overflow -fno-omit-frame-pointer)
endif()

# For changing the kernels (docs/kernels.md): those of all features, for this processor.
option(MIRRORBALL_LAB "Compile kernels for this processor alone, in as few variants as render any scene" OFF)
if(MIRRORBALL_LAB)
    set(NATIVE_SETS all)
    set(NATIVE_FEWER_WIDTHS 1)  # and that of a vector
    file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
    set(NATIVE_FEWER_ISAS x86-64)
    if(flags MATCHES " avx512vl( |$)")
        set(NATIVE_FEWER_ISAS x86-64-v4)
    elseif(flags MATCHES " avx2( |$)")
        set(NATIVE_FEWER_ISAS x86-64-v3)
    endif()
endif()

# Each instruction set: its flags, and how many floats and doubles a vector holds.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(MIRRORBALL_NATIVE_ISAS x86-64-v4 x86-64-v3 x86-64 CACHE STRING
        "Instruction sets to compile kernels for, the best first")
    if(NATIVE_FEWER_ISAS)
        set(MIRRORBALL_NATIVE_ISAS ${NATIVE_FEWER_ISAS})
    endif()
    # scripts/test compiles those that its machine has better ones than in fewer variants.
    set(MIRRORBALL_LEAN_ISAS "" CACHE STRING "Instruction sets without kernels for plain scenes and meshes")
    set(x86-64-v4_FLAGS -march=x86-64-v4 -mprefer-vector-width=512)
    set(x86-64-v4_WIDTHS 16 8)
    set(x86-64-v3_FLAGS -march=x86-64-v3)
    set(x86-64-v3_WIDTHS 8 4)
    # Without FMA. v2 has none either and is no faster: measured on cornell-box and glass.
    set(x86-64_FLAGS -march=x86-64)
    set(x86-64_WIDTHS 4 2)
else()
    set(MIRRORBALL_NATIVE_ISAS generic CACHE STRING "Instruction sets to compile kernels for")
    set(generic_FLAGS "")
    set(generic_WIDTHS 4 2)
endif()

# What a set of features leaves out, the leanest set first: a scene takes the first that holds all it
# needs. `plain` is the paper's scene, `mesh` a model among mirror balls; with _4 where a pixel has 4
# samples, with _edges for Sobol samples and edges. Single rays are traced by `all` alone.
set(NATIVE_MESH -DRT_TRACES_RAYS=0
    -DRT_FEATURE_BITS=0x1fff&~RT_HUGE_SPHERES&~RT_EYE_ON_SURFACE&~RT_CONES&~RT_GLASS&~RT_FILTERS)
set(NATIVE_PLAIN ${NATIVE_MESH}&~RT_VERTEX_NORMALS&~RT_HIERARCHY)
set(NATIVE_GRID "&~RT_SOBOL&~RT_EDGES")
set(plain_4_FLAGS ${NATIVE_PLAIN}${NATIVE_GRID} -DRT_SAMPLES=4)
set(plain_FLAGS ${NATIVE_PLAIN}${NATIVE_GRID})
set(plain_edges_FLAGS ${NATIVE_PLAIN})
set(mesh_4_FLAGS ${NATIVE_MESH}${NATIVE_GRID} -DRT_SAMPLES=4)
set(mesh_FLAGS ${NATIVE_MESH}${NATIVE_GRID})
set(mesh_edges_FLAGS ${NATIVE_MESH})
set(all_FLAGS "")

# compile_native_kernel(OBJECT SOURCE NAME FLAGS...)
function(compile_native_kernel OBJECT SOURCE NAME)
    add_custom_command(
        OUTPUT ${OBJECT}
        COMMAND ${KERNEL_CLANG} ${NATIVE_KERNEL_FLAGS} ${ARGN} -DRT_NATIVE_NAME=${NAME}
                -MD -MF ${OBJECT}.d -MT ${OBJECT} -c ${SOURCE} -o ${OBJECT}
        DEPENDS ${SOURCE} DEPFILE ${OBJECT}.d
        COMMENT "Compiling ${NAME}" VERBATIM)
endfunction()

function(add_native_kernels LIBRARY)
    set(folder ${CMAKE_BINARY_DIR}/native)
    if(NOT MIRRORBALL_NATIVE)
        set(MIRRORBALL_NATIVE_ISAS "")
    endif()
    file(MAKE_DIRECTORY ${folder})
    set(objects "")
    set(old_isa x86-64)  # slow whatever is left out: fma is a call
    set(lean_isas ${old_isa} ${MIRRORBALL_LEAN_ISAS})
    set(names_float "")
    set(names_double "")
    foreach(isa IN LISTS MIRRORBALL_NATIVE_ISAS)
        foreach(type float double)
            set(real "")
            list(GET ${isa}_WIDTHS 0 width)
            if(type STREQUAL double)
                set(real -DRT_DOUBLE=1)
                list(GET ${isa}_WIDTHS 1 width)
            endif()
            foreach(set IN LISTS NATIVE_SETS)
                set(widths 1 ${width})
                if(isa IN_LIST lean_isas)
                    if(set MATCHES _4 AND type STREQUAL float AND NOT isa STREQUAL old_isa)
                        set(widths ${width})  # what most pictures take
                    elseif(NOT set STREQUAL all)
                        set(widths "")
                    endif()
                elseif(NATIVE_FEWER_WIDTHS)
                    set(widths ${NATIVE_FEWER_WIDTHS} ${width})
                elseif(set STREQUAL all)
                    set(widths 1 2 4 8 16)
                elseif(set MATCHES "_4|_edges")
                    set(widths ${width})  # what most pictures take
                endif()
                foreach(lanes IN LISTS widths)
                    string(MAKE_C_IDENTIFIER rt_${isa}_${type}_${lanes}_${set} name)
                    compile_native_kernel(${folder}/${name}.o
                        ${CMAKE_SOURCE_DIR}/kernels/native/native.cl ${name}
                        ${${isa}_FLAGS} ${real} -DRT_LANES=${lanes} ${${set}_FLAGS})
                    list(APPEND objects ${folder}/${name}.o)
                    string(APPEND names_${type} "    X(${name}, \"${isa}\", ${width}) \\\n")
                endforeach()
            endforeach()
        endforeach()
    endforeach()
    # The tracer that tells what a path meets; for any processor.
    set(isa "")
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
        set(isa ${x86-64_FLAGS})
    endif()
    if(MIRRORBALL_NATIVE)
        compile_native_kernel(${folder}/rt_explain.o ${CMAKE_SOURCE_DIR}/kernels/native/explain.cl rt_explain
            ${isa} -DRT_DOUBLE=1 -DRT_LANES=1 -DRT_TRACES_RAYS=0)
        list(APPEND objects ${folder}/rt_explain.o)
    endif()
    set(table ${folder}/native_table.h)
    file(CONFIGURE OUTPUT ${table} CONTENT
"// Generated by cmake/native_kernels.cmake: X(name, instruction set, its lanes), the leanest first.
#define RT_NATIVE_FLOAT(X) \\
@names_float@
#define RT_NATIVE_DOUBLE(X) \\
@names_double@
" @ONLY)
    add_library(${LIBRARY} STATIC ${table} ${objects})
    set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
    set_target_properties(${LIBRARY} PROPERTIES LINKER_LANGUAGE CXX)
    target_include_directories(${LIBRARY} INTERFACE ${folder})
endfunction()
