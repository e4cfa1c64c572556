# SPDX-License-Identifier: Apache-2.0
# tests/native_probes.cl compiled ahead of time: a shared object for each precision and width of a
# packet in NATIVE_PROBES: the narrowest, a middle one and the widest. With the flags of pthreads' kernels,
# but less optimized: each probe holds all it calls, and would take long.
file(MAKE_DIRECTORY ${NATIVE_PROBES})
set(native_probe_flags ${NATIVE_KERNEL_FLAGS} -O1
    -DRT_RENDERS_PIXELS=0 -DRT_RENDERS_SAMPLES=0 -DRT_RENDERS_ADAPTIVE=0 -DRT_TRACES_RAYS=0)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND native_probe_flags -march=x86-64-v3)
endif()

set(native_probe_objects "")
foreach(type float double)
    foreach(lanes 1 4 16)
        set(object ${NATIVE_PROBES}/probes_${type}_${lanes}.so)
        set(real "")
        if(type STREQUAL double)
            set(real -DRT_DOUBLE=1)
        endif()
        add_custom_command(
            OUTPUT ${object}
            COMMAND ${KERNEL_CLANG} ${native_probe_flags} ${real} -DRT_LANES=${lanes} -shared
                    -MD -MF ${object}.d -MT ${object}
                    ${CMAKE_CURRENT_SOURCE_DIR}/native_probes.cl -o ${object}
            DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/native_probes.cl DEPFILE ${object}.d
            COMMENT "Compiling probes of ${lanes} lanes in ${type}" VERBATIM)
        list(APPEND native_probe_objects ${object})
    endforeach()
endforeach()
add_custom_target(native_probes DEPENDS ${native_probe_objects})
