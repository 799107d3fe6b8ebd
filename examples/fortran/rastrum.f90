! SPDX-License-Identifier: BSD-3-Clause
! The functions of rastrum.h that draw.f90 calls; further ones are declared in the same way: handles
! and arrays of C are type(c_ptr), what C takes by value has `value`.
module rastrum
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: RASTRUM_FLOAT32 = 0, RASTRUM_INT32 = 7, RASTRUM_PER_VERTEX = 0
  type, bind(c) :: rastrum_array
    type(c_ptr) :: data
    integer(c_size_t) :: count
    integer(c_int) :: type, channels
    integer(c_ptrdiff_t) :: stride_bytes = 0
  end type

  interface
    type(c_ptr) function rastrum_error_text() bind(c)
      import
    end function
    type(c_ptr) function rastrum_scene_new() bind(c)
      import
    end function
    type(c_ptr) function rastrum_camera_new() bind(c)
      import
    end function
    type(c_ptr) function rastrum_frame_new(width, height) bind(c)
      import
      integer(c_int), value :: width, height
    end function
    type(c_ptr) function rastrum_renderer_new() bind(c)
      import
    end function
    subroutine rastrum_scene_free(scene) bind(c)
      import
      type(c_ptr), value :: scene
    end subroutine
    subroutine rastrum_camera_free(camera) bind(c)
      import
      type(c_ptr), value :: camera
    end subroutine
    subroutine rastrum_frame_free(frame) bind(c)
      import
      type(c_ptr), value :: frame
    end subroutine
    subroutine rastrum_renderer_free(renderer) bind(c)
      import
      type(c_ptr), value :: renderer
    end subroutine
    integer(c_int) function rastrum_scene_add_mesh(scene, positions, indices, instance) bind(c)
      import
      type(c_ptr), value :: scene
      type(rastrum_array), value :: positions, indices
      integer(c_size_t) :: instance
    end function
    integer(c_int) function rastrum_instance_set_colors(scene, instance, colors, per) bind(c)
      import
      type(c_ptr), value :: scene
      integer(c_size_t), value :: instance
      type(rastrum_array), value :: colors
      integer(c_int), value :: per
    end function
    integer(c_int) function rastrum_camera_look_at(camera, eye, target, up) bind(c)
      import
      type(c_ptr), value :: camera
      real(c_double) :: eye(3), target(3), up(3)
    end function
    integer(c_int) function rastrum_camera_fit(camera, scene, width, height) bind(c)
      import
      type(c_ptr), value :: camera, scene
      integer(c_int), value :: width, height
    end function
    integer(c_int) function rastrum_frame_set_background(frame, rgba) bind(c)
      import
      type(c_ptr), value :: frame
      real(c_float) :: rgba(4)
    end function
    integer(c_int) function rastrum_frame_set_target(frame, name, pixels, bytes, stride_bytes) bind(c)
      import
      type(c_ptr), value :: frame, pixels
      character(kind=c_char) :: name(*)
      integer(c_size_t), value :: bytes
      integer(c_ptrdiff_t), value :: stride_bytes
    end function
    integer(c_int) function rastrum_frame_digest(frame, name, digest) bind(c)
      import
      type(c_ptr), value :: frame
      character(kind=c_char) :: name(*), digest(65)
    end function
    integer(c_int) function rastrum_render(renderer, scene, camera, frame) bind(c)
      import
      type(c_ptr), value :: renderer, scene, camera, frame
    end function
  end interface

contains

  ! Ends the program with Rastrum's sentence unless a call went well.
  subroutine check(status)
    integer(c_int), intent(in) :: status
    character(kind=c_char), pointer :: text(:)
    integer :: length
    if (status == 0) return
    call c_f_pointer(rastrum_error_text(), text, [4096])
    length = 0
    do while (text(length + 1) /= c_null_char)
      length = length + 1
    end do
    print '(4096a)', text(:length)
    stop 1
  end subroutine
end module
