! SPDX-License-Identifier: BSD-3-Clause
! Draws a coloured tetrahedron through the C interface, writes the picture as a PPM file where a name
! is given, and prints its digest, which is the same on every machine and in every language.
program draw
  use rastrum
  implicit none
  integer(c_int), parameter :: W = 320, H = 240
  ! The first index is the fastest, so each column is a position, a triangle, a pixel. Indices count
  ! from 0, as in C.
  real(c_float), target :: positions(3, 4) = &
    reshape([real(c_float) :: 1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1], [3, 4])
  integer(c_int32_t), target :: triangles(3, 4) = reshape([0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3], [3, 4])
  real(c_float), target :: colors(3, 4) = &
    reshape([real(c_float) :: 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0], [3, 4])
  integer(c_int8_t), target :: pixels(4, W, H)
  character(kind=c_char) :: digest(65)
  character(len=255) :: file
  integer(c_size_t) :: mesh
  integer :: unit
  type(c_ptr) :: scene, camera, frame, renderer

  scene = rastrum_scene_new()
  camera = rastrum_camera_new()
  frame = rastrum_frame_new(W, H)
  renderer = rastrum_renderer_new()
  call check(rastrum_scene_add_mesh(scene, &
    rastrum_array(c_loc(positions), 4, RASTRUM_FLOAT32, 3), &
    rastrum_array(c_loc(triangles), 12, RASTRUM_INT32, 1), mesh))
  call check(rastrum_instance_set_colors(scene, mesh, &
    rastrum_array(c_loc(colors), 4, RASTRUM_FLOAT32, 3), RASTRUM_PER_VERTEX))
  call check(rastrum_camera_look_at(camera, [3d0, 2d0, 5d0], [0d0, 0d0, 0d0], [0d0, 1d0, 0d0]))
  call check(rastrum_camera_fit(camera, scene, W, H))
  call check(rastrum_frame_set_background(frame, [1.0, 1.0, 1.0, 1.0]))
  call check(rastrum_frame_set_target(frame, "color8" // c_null_char, c_loc(pixels), &
    size(pixels, kind=c_size_t), 0_c_ptrdiff_t))
  call check(rastrum_render(renderer, scene, camera, frame))
  call check(rastrum_frame_digest(frame, "color8" // c_null_char, digest))
  print '(64a)', digest(:64)

  if (command_argument_count() > 0) then
    call get_command_argument(1, file)
    open (newunit=unit, file=file, access="stream", status="replace")
    write (unit) "P6 320 240 255" // new_line("a"), pixels(:3, :, :)
    close (unit)
  end if
  call rastrum_renderer_free(renderer)
  call rastrum_frame_free(frame)
  call rastrum_camera_free(camera)
  call rastrum_scene_free(scene)
end program
