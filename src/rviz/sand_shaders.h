#pragma once

namespace shallow_sand {

/// GLSL 1.20: what software rendering and old graphics cards know, too.
constexpr char kVertexShader[] = R"(#version 120
uniform mat4 to_screen;
uniform float show_sand;
varying vec4 place_and_depth;  // from the map's corner [m]
varying vec4 normal_value_openness; // the normal's x and y


void main() {
  place_and_depth = vec4(gl_Vertex.xyz, gl_MultiTexCoord0.x);
  if (show_sand < 0.5) place_and_depth.z -= max(place_and_depth.w, 0.0);
  gl_Position = to_screen * vec4(place_and_depth.xyz, 1.0);
  normal_value_openness = vec4(gl_Normal.xy, gl_MultiTexCoord0.yz);
}
)";

constexpr char kFragmentShader[] = R"(#version 120
uniform vec4 sand_color;
uniform vec4 bed_color;
uniform float color_by;  // as ColorBy counts
uniform vec4 range;
uniform vec4 palette0;
uniform vec4 palette1;
uniform vec4 palette2;
uniform vec4 palette3;
uniform vec4 palette4;
uniform vec4 palette5;
uniform float shore;
uniform float contour_interval;
uniform float alpha;
uniform float show_sand;
varying vec4 place_and_depth;
varying vec4 normal_value_openness;
vec3 place;

vec3 scaleColor(float shown) {
  float t = 5.0 * clamp((shown - range.x) / max(range.y - range.x, 1e-9), 0.0, 1.0);
  vec3 color = palette0.rgb;
  color = mix(color, palette1.rgb, clamp(t, 0.0, 1.0));
  color = mix(color, palette2.rgb, clamp(t - 1.0, 0.0, 1.0));
  color = mix(color, palette3.rgb, clamp(t - 2.0, 0.0, 1.0));
  color = mix(color, palette4.rgb, clamp(t - 3.0, 0.0, 1.0));
  return mix(color, palette5.rgb, clamp(t - 4.0, 0.0, 1.0));
}

// A number from 0 to 1 for each square of a lattice.
float speckle(vec2 square) {
  return fract(sin(dot(mod(floor(square), 1024.0), vec2(12.9898, 78.233))) * 43758.5453);
}

// Grains of a size, as long as one is larger than a pixel.
float grains(float size) {
  float squares_in_pixel = length(fwidth(place.xy)) / size;
  return (speckle(place.xy / size) - 0.5) * clamp(1.5 - squares_in_pixel, 0.0, 1.0);
}

void main() {
  place = place_and_depth.xyz;
  float depth = place_and_depth.w;
  float value = normal_value_openness.z;
  float openness = normal_value_openness.w;
  vec2 tilt = normal_value_openness.xy;
  vec3 up = normalize(vec3(tilt, sqrt(max(1.0 - dot(tilt, tilt), 0.0))));
  vec3 sand = sand_color.rgb;
  // Only the cut along the map's sides stands upright, but for roundings; a scale of colours says nothing there.
  bool is_surface = up.z > 3e-3;
  if (color_by > 0.5 && is_surface) {
    float shown = value;
    if (color_by < 1.5) shown = place.z;
    else if (color_by < 2.5) shown = depth;
    else if (color_by < 3.5) shown = length(up.xy) / max(up.z, 1e-6);
    sand = scaleColor(shown);
  } else {
    sand *= 1.0 + 0.12 * grains(0.004) + 0.05 * grains(0.016);
  }
  // The shore is as sharp as the screen, whatever the cells are.
  float is_sand = clamp((depth - shore) / max(fwidth(depth), 1e-9) + 0.5, 0.0, 1.0);
  vec3 color = mix(bed_color.rgb, sand, is_sand * show_sand);

  // A low sun in the north-west, and a sky that reaches less far down into ruts.
  float sun = max(dot(up, normalize(vec3(-0.55, 0.60, 0.62))), 0.0);
  float sky = (0.25 + 0.75 * openness * openness) * (0.65 + 0.35 * up.z);
  color *= 0.92 * sun * mix(0.55, 1.0, openness) * vec3(1.05, 1.0, 0.92) + 0.50 * sky * vec3(0.93, 0.98, 1.10);

  if (contour_interval > 0.0 && is_surface) {
    // Half an interval off, for level ground mostly lies at a round number.
    float level = place.z / contour_interval + 0.5;
    float levels_in_pixel = fwidth(level);
    float away = abs(fract(level - 0.5) - 0.5) / max(levels_in_pixel, 1e-6);
    // Not where they would run into each other.
    float drawn = clamp(2.0 - 4.0 * levels_in_pixel, 0.0, 1.0);
    color *= 1.0 - 0.45 * (1.0 - smoothstep(0.5, 1.3, away)) * drawn;
  }
  gl_FragColor = vec4(color, alpha);
}
)";

}  // namespace shallow_sand
