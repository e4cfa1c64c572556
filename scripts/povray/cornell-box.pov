// SPDX-License-Identifier: Apache-2.0
// scenes/cornell-box.json for POV-Ray 3.7; rendered by scripts/compare-povray.
//
// Coordinates are the original's: POV-Ray is left-handed only where look_at and angle choose the
// camera's vectors, and here they are given. `specular` with `roughness` 1/p is Blinn's lobe
// max(0, n.h)^p, untinted: gold's yellow highlight needs `metallic`, which whitens it at grazing
// angles. Ambient is ambient * pigment * ambient_light; nothing fades with distance; nothing is
// cut off as too dark (adc_bailout).
#version 3.7;

global_settings {
    assumed_gamma 1.0
    ambient_light rgb 0.2
    max_trace_level 9  // an eye ray and 8 mirror rays
    adc_bailout 0
}

background { rgb 0 }

camera {
    perspective
    location <0, 0, 2>
    direction <0, 0, -0.8660254037844387>  // 60 degrees across a width of 1
    right <1, 0, 0>
    up <0, 1, 0>
}

light_source { <0, 0.7, 0>, rgb 0.5 }
light_source { <-0.5, 0.5, 2>, rgb 0.3 }

#declare Orange = texture {
    pigment { rgb <1, 0.3, 0> }
    finish { ambient 1 diffuse 1 specular 0.8 roughness 1/100 reflection { 0.05 } }
}
#declare Mirror = texture {
    pigment { rgb 1 }
    finish { ambient 0.01 diffuse 0.01 specular 0.5 roughness 1/100 reflection { 0.6 } }
}
#declare White = texture {
    pigment { rgb 1 }
    finish { ambient 1 diffuse 0.75 specular 0.25 roughness 1/10 }
}
#declare Red = texture {
    pigment { rgb <1, 0.3, 0.3> }
    finish { ambient 1 diffuse 1 specular 0.25 roughness 1/10 reflection { 0.1 } }
}
#declare Green = texture {
    pigment { rgb <0.3, 1, 0.3> }
    finish { ambient 1 diffuse 1 specular 0.25 roughness 1/10 reflection { 0.1 } }
}
#declare Gold = texture {
    pigment { rgb <1, 1, 0.5> }
    finish {
        ambient rgb <0.01, 0.01, 0.02>  // times the pigment: 0.01 of each
        diffuse 0.6
        specular 1 metallic roughness 1/100
        reflection { rgb <0.6, 0.6, 0.3> }
    }
}

sphere { <-0.33, -0.75, -0.33>, 0.25 texture { Orange } }
sphere { <0.33, -0.75, 0.33>, 0.25 texture { Mirror } }

// floor
triangle { <-1, -1, 1>, <1, -1, 1>, <1, -1, -1> texture { White } }
triangle { <-1, -1, 1>, <1, -1, -1>, <-1, -1, -1> texture { White } }
// back wall
triangle { <-1, -1, -1>, <1, -1, -1>, <1, 1, -1> texture { White } }
triangle { <-1, -1, -1>, <1, 1, -1>, <-1, 1, -1> texture { White } }
// ceiling
triangle { <-1, 1, -1>, <1, 1, -1>, <1, 1, 1> texture { White } }
triangle { <-1, 1, -1>, <1, 1, 1>, <-1, 1, 1> texture { White } }
// left wall
triangle { <-1, -1, 1>, <-1, -1, -1>, <-1, 1, -1> texture { Red } }
triangle { <-1, -1, 1>, <-1, 1, -1>, <-1, 1, 1> texture { Red } }
// right wall
triangle { <1, -1, -1>, <1, -1, 1>, <1, 1, 1> texture { Green } }
triangle { <1, -1, -1>, <1, 1, 1>, <1, 1, -1> texture { Green } }
// three gold mirrors, leaning on the back wall
triangle { <0, 0.5, -1>, <-0.25, 0, -0.95>, <0.25, 0, -0.95> texture { Gold } }
triangle { <-0.25, 0, -0.95>, <-0.5, -0.5, -1>, <0, -0.5, -0.95> texture { Gold } }
triangle { <0.25, 0, -0.95>, <0, -0.5, -0.95>, <0.5, -0.5, -1> texture { Gold } }
