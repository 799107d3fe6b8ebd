// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL 4.5 functions that the peers call. EGL loads them, so only libEGL is linked, and any
// libGL works.
#pragma once

#include <GL/glcorearb.h>

#include <string>

#include <rastrum/error.hpp>

namespace rastrum::bench {

/// eglGetProcAddress.
using GlLoader = void (*(*)(const char* name))();

/// Loads a function of the driver as the requested pointer type; null without a loader.
struct GlFunction {
  GlLoader load;
  const char* name;

  /// Throws Error{no_device} if the driver lacks the function.
  template <class Pointer>
  operator Pointer() const {  // NOLINT(google-explicit-constructor)
    if (load == nullptr) return nullptr;
    const auto function = reinterpret_cast<Pointer>(load(name));
    if (function == nullptr)
      throw Error(Errc::no_device, std::string("OpenGL: the driver has no ") + name);
    return function;
  }
};

/// All functions, loaded by the constructor.
struct GlApi {
  GlLoader load = nullptr;
  PFNGLGETSTRINGPROC GetString = GlFunction{load, "glGetString"};
  PFNGLGETERRORPROC GetError = GlFunction{load, "glGetError"};
  PFNGLGETINTEGERVPROC GetIntegerv = GlFunction{load, "glGetIntegerv"};
  PFNGLENABLEPROC Enable = GlFunction{load, "glEnable"};
  PFNGLDISABLEPROC Disable = GlFunction{load, "glDisable"};
  PFNGLCLIPCONTROLPROC ClipControl = GlFunction{load, "glClipControl"};
  PFNGLDEPTHFUNCPROC DepthFunc = GlFunction{load, "glDepthFunc"};
  PFNGLDEPTHMASKPROC DepthMask = GlFunction{load, "glDepthMask"};
  PFNGLBLENDFUNCPROC BlendFunc = GlFunction{load, "glBlendFunc"};
  PFNGLVIEWPORTPROC Viewport = GlFunction{load, "glViewport"};
  PFNGLPIXELSTOREIPROC PixelStorei = GlFunction{load, "glPixelStorei"};
  PFNGLREADBUFFERPROC ReadBuffer = GlFunction{load, "glReadBuffer"};
  PFNGLREADPIXELSPROC ReadPixels = GlFunction{load, "glReadPixels"};
  PFNGLFINISHPROC Finish = GlFunction{load, "glFinish"};
  PFNGLCLEARBUFFERFVPROC ClearBufferfv = GlFunction{load, "glClearBufferfv"};
  PFNGLCLEARBUFFERIVPROC ClearBufferiv = GlFunction{load, "glClearBufferiv"};
  PFNGLGENBUFFERSPROC GenBuffers = GlFunction{load, "glGenBuffers"};
  PFNGLDELETEBUFFERSPROC DeleteBuffers = GlFunction{load, "glDeleteBuffers"};
  PFNGLBINDBUFFERPROC BindBuffer = GlFunction{load, "glBindBuffer"};
  PFNGLBUFFERDATAPROC BufferData = GlFunction{load, "glBufferData"};
  PFNGLBUFFERSUBDATAPROC BufferSubData = GlFunction{load, "glBufferSubData"};
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays = GlFunction{load, "glGenVertexArrays"};
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = GlFunction{load, "glBindVertexArray"};
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray =
      GlFunction{load, "glEnableVertexAttribArray"};
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = GlFunction{load, "glVertexAttribPointer"};
  PFNGLDRAWELEMENTSPROC DrawElements = GlFunction{load, "glDrawElements"};
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = GlFunction{load, "glGenFramebuffers"};
  PFNGLDELETEFRAMEBUFFERSPROC DeleteFramebuffers = GlFunction{load, "glDeleteFramebuffers"};
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = GlFunction{load, "glBindFramebuffer"};
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer =
      GlFunction{load, "glFramebufferRenderbuffer"};
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus =
      GlFunction{load, "glCheckFramebufferStatus"};
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = GlFunction{load, "glGenRenderbuffers"};
  PFNGLDELETERENDERBUFFERSPROC DeleteRenderbuffers = GlFunction{load, "glDeleteRenderbuffers"};
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = GlFunction{load, "glBindRenderbuffer"};
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = GlFunction{load, "glRenderbufferStorage"};
  PFNGLCREATESHADERPROC CreateShader = GlFunction{load, "glCreateShader"};
  PFNGLSHADERSOURCEPROC ShaderSource = GlFunction{load, "glShaderSource"};
  PFNGLCOMPILESHADERPROC CompileShader = GlFunction{load, "glCompileShader"};
  PFNGLGETSHADERIVPROC GetShaderiv = GlFunction{load, "glGetShaderiv"};
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = GlFunction{load, "glGetShaderInfoLog"};
  PFNGLCREATEPROGRAMPROC CreateProgram = GlFunction{load, "glCreateProgram"};
  PFNGLATTACHSHADERPROC AttachShader = GlFunction{load, "glAttachShader"};
  PFNGLLINKPROGRAMPROC LinkProgram = GlFunction{load, "glLinkProgram"};
  PFNGLGETPROGRAMIVPROC GetProgramiv = GlFunction{load, "glGetProgramiv"};
  PFNGLUSEPROGRAMPROC UseProgram = GlFunction{load, "glUseProgram"};
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = GlFunction{load, "glGetUniformLocation"};
  PFNGLUNIFORM4FVPROC Uniform4fv = GlFunction{load, "glUniform4fv"};
  PFNGLGENQUERIESPROC GenQueries = GlFunction{load, "glGenQueries"};
  PFNGLBEGINQUERYPROC BeginQuery = GlFunction{load, "glBeginQuery"};
  PFNGLENDQUERYPROC EndQuery = GlFunction{load, "glEndQuery"};
  PFNGLGETQUERYOBJECTUI64VPROC GetQueryObjectui64v = GlFunction{load, "glGetQueryObjectui64v"};
  PFNGLACTIVETEXTUREPROC ActiveTexture = GlFunction{load, "glActiveTexture"};
  PFNGLBINDBUFFERBASEPROC BindBufferBase = GlFunction{load, "glBindBufferBase"};
  PFNGLBINDTEXTUREPROC BindTexture = GlFunction{load, "glBindTexture"};
  PFNGLCLEARBUFFERDATAPROC ClearBufferData = GlFunction{load, "glClearBufferData"};
  PFNGLCOLORMASKPROC ColorMask = GlFunction{load, "glColorMask"};
  PFNGLDELETEPROGRAMPROC DeleteProgram = GlFunction{load, "glDeleteProgram"};
  PFNGLDELETETEXTURESPROC DeleteTextures = GlFunction{load, "glDeleteTextures"};
  PFNGLDRAWARRAYSPROC DrawArrays = GlFunction{load, "glDrawArrays"};
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D = GlFunction{load, "glFramebufferTexture2D"};
  PFNGLGENTEXTURESPROC GenTextures = GlFunction{load, "glGenTextures"};
  PFNGLMEMORYBARRIERPROC MemoryBarrier = GlFunction{load, "glMemoryBarrier"};
  PFNGLTEXSTORAGE2DPROC TexStorage2D = GlFunction{load, "glTexStorage2D"};
  PFNGLUNIFORM1FPROC Uniform1f = GlFunction{load, "glUniform1f"};
  PFNGLUNIFORM1IPROC Uniform1i = GlFunction{load, "glUniform1i"};
  PFNGLCULLFACEPROC CullFace = GlFunction{load, "glCullFace"};
  PFNGLFRONTFACEPROC FrontFace = GlFunction{load, "glFrontFace"};
  PFNGLTEXPARAMETERIPROC TexParameteri = GlFunction{load, "glTexParameteri"};
  PFNGLTEXSUBIMAGE2DPROC TexSubImage2D = GlFunction{load, "glTexSubImage2D"};
};

}  // namespace rastrum::bench
