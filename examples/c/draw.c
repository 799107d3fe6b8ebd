// SPDX-License-Identifier: BSD-3-Clause
// Draws a coloured tetrahedron through the C interface, writes a PPM file if a name is given, and
// prints the picture's digest, which is the same on every machine.
#include <stdio.h>
#include <stdlib.h>

#include <rastrum.h>

enum { W = 320, H = 240 };

static void check(rastrum_status status) {
  if (status == RASTRUM_OK) return;
  fprintf(stderr, "draw: %s\n", rastrum_error_text());
  exit(1);
}

static void write_ppm(const char* file, const uint8_t* pixels) {
  FILE* out = fopen(file, "wb");
  if (out == NULL) {
    perror(file);
    exit(1);
  }
  fprintf(out, "P6 %d %d 255\n", W, H);
  for (int i = 0; i < W * H; ++i) fwrite(pixels + 4 * i, 1, 3, out);
  fclose(out);
}

int main(int argc, char** argv) {
  static const float positions[4][3] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  static const int32_t triangles[4][3] = {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}};
  static const float colors[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  static const double eye[3] = {3, 2, 5}, middle[3] = {0, 0, 0}, up[3] = {0, 1, 0};
  static const float white[4] = {1, 1, 1, 1};
  static uint8_t pixels[4 * W * H];
  rastrum_scene* scene = rastrum_scene_new();
  rastrum_camera* camera = rastrum_camera_new();
  rastrum_frame* frame = rastrum_frame_new(W, H);
  rastrum_renderer* renderer = rastrum_renderer_new();

  size_t mesh;
  rastrum_array corners = {positions, 4, RASTRUM_FLOAT32, 3, 0};
  rastrum_array indices = {triangles, 12, RASTRUM_INT32, 1, 0};
  rastrum_array rgb = {colors, 4, RASTRUM_FLOAT32, 3, 0};
  check(rastrum_scene_add_mesh(scene, corners, indices, &mesh));
  check(rastrum_instance_set_colors(scene, mesh, rgb, RASTRUM_PER_VERTEX));
  check(rastrum_camera_look_at(camera, eye, middle, up));
  check(rastrum_camera_fit(camera, scene, W, H));
  check(rastrum_frame_set_background(frame, white));
  check(rastrum_frame_set_target(frame, "color8", pixels, sizeof pixels, 0));
  check(rastrum_render(renderer, scene, camera, frame));

  char digest[65];
  check(rastrum_frame_digest(frame, "color8", digest));
  puts(digest);
  if (argc > 1) write_ppm(argv[1], pixels);
  rastrum_renderer_free(renderer);
  rastrum_frame_free(frame);
  rastrum_camera_free(camera);
  rastrum_scene_free(scene);
}
