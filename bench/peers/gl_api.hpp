// The OpenGL 4.5 functions that the peers call, fetched through EGL: so that nothing but libEGL is
// linked, and a machine with another libGL works.
#pragma once

#include <GL/glcorearb.h>

#include <string>
#include <type_traits>

#include <rastrum/error.hpp>

namespace rastrum::bench {

struct GlApi {
  PFNGLGETSTRINGPROC GetString = nullptr;
  PFNGLGETERRORPROC GetError = nullptr;
  PFNGLGETINTEGERVPROC GetIntegerv = nullptr;
  PFNGLENABLEPROC Enable = nullptr;
  PFNGLDISABLEPROC Disable = nullptr;
  PFNGLCLIPCONTROLPROC ClipControl = nullptr;
  PFNGLDEPTHFUNCPROC DepthFunc = nullptr;
  PFNGLDEPTHMASKPROC DepthMask = nullptr;
  PFNGLBLENDFUNCPROC BlendFunc = nullptr;
  PFNGLVIEWPORTPROC Viewport = nullptr;
  PFNGLPIXELSTOREIPROC PixelStorei = nullptr;
  PFNGLREADBUFFERPROC ReadBuffer = nullptr;
  PFNGLREADPIXELSPROC ReadPixels = nullptr;
  PFNGLFINISHPROC Finish = nullptr;
  PFNGLCLEARBUFFERFVPROC ClearBufferfv = nullptr;
  PFNGLCLEARBUFFERIVPROC ClearBufferiv = nullptr;
  PFNGLGENBUFFERSPROC GenBuffers = nullptr;
  PFNGLDELETEBUFFERSPROC DeleteBuffers = nullptr;
  PFNGLBINDBUFFERPROC BindBuffer = nullptr;
  PFNGLBUFFERDATAPROC BufferData = nullptr;
  PFNGLBUFFERSUBDATAPROC BufferSubData = nullptr;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays = nullptr;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = nullptr;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray = nullptr;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = nullptr;
  PFNGLDRAWELEMENTSPROC DrawElements = nullptr;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = nullptr;
  PFNGLDELETEFRAMEBUFFERSPROC DeleteFramebuffers = nullptr;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = nullptr;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer = nullptr;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus = nullptr;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = nullptr;
  PFNGLDELETERENDERBUFFERSPROC DeleteRenderbuffers = nullptr;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = nullptr;
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = nullptr;
  PFNGLCREATESHADERPROC CreateShader = nullptr;
  PFNGLSHADERSOURCEPROC ShaderSource = nullptr;
  PFNGLCOMPILESHADERPROC CompileShader = nullptr;
  PFNGLGETSHADERIVPROC GetShaderiv = nullptr;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = nullptr;
  PFNGLCREATEPROGRAMPROC CreateProgram = nullptr;
  PFNGLATTACHSHADERPROC AttachShader = nullptr;
  PFNGLLINKPROGRAMPROC LinkProgram = nullptr;
  PFNGLGETPROGRAMIVPROC GetProgramiv = nullptr;
  PFNGLUSEPROGRAMPROC UseProgram = nullptr;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = nullptr;
  PFNGLUNIFORM4FVPROC Uniform4fv = nullptr;
  PFNGLGENQUERIESPROC GenQueries = nullptr;
  PFNGLBEGINQUERYPROC BeginQuery = nullptr;
  PFNGLENDQUERYPROC EndQuery = nullptr;
  PFNGLGETQUERYOBJECTUI64VPROC GetQueryObjectui64v = nullptr;
  PFNGLACTIVETEXTUREPROC ActiveTexture = nullptr;
  PFNGLBINDBUFFERBASEPROC BindBufferBase = nullptr;
  PFNGLBINDTEXTUREPROC BindTexture = nullptr;
  PFNGLCLEARBUFFERDATAPROC ClearBufferData = nullptr;
  PFNGLCOLORMASKPROC ColorMask = nullptr;
  PFNGLDELETEPROGRAMPROC DeleteProgram = nullptr;
  PFNGLDELETETEXTURESPROC DeleteTextures = nullptr;
  PFNGLDRAWARRAYSPROC DrawArrays = nullptr;
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D = nullptr;
  PFNGLGENTEXTURESPROC GenTextures = nullptr;
  PFNGLMEMORYBARRIERPROC MemoryBarrier = nullptr;
  PFNGLTEXSTORAGE2DPROC TexStorage2D = nullptr;
  PFNGLUNIFORM1FPROC Uniform1f = nullptr;
  PFNGLUNIFORM1IPROC Uniform1i = nullptr;
  PFNGLCULLFACEPROC CullFace = nullptr;
  PFNGLFRONTFACEPROC FrontFace = nullptr;
  PFNGLTEXPARAMETERIPROC TexParameteri = nullptr;
  PFNGLTEXSUBIMAGE2DPROC TexSubImage2D = nullptr;

  /// Fetches all of them with `get_proc_address(name)`; throws Error{no_device} naming the first
  /// that is missing.
  template <class GetProcAddress>
  static GlApi load(GetProcAddress get_proc_address) {
    GlApi gl;
    const auto fetch = [&](auto& function, const char* name) {
      using Function = std::remove_reference_t<decltype(function)>;
      function = reinterpret_cast<Function>(get_proc_address(name));
      if (function == nullptr)
        throw Error(Errc::no_device, std::string("OpenGL: the driver has no ") + name);
    };
    fetch(gl.GetString, "glGetString");
    fetch(gl.GetError, "glGetError");
    fetch(gl.GetIntegerv, "glGetIntegerv");
    fetch(gl.Enable, "glEnable");
    fetch(gl.Disable, "glDisable");
    fetch(gl.ClipControl, "glClipControl");
    fetch(gl.DepthFunc, "glDepthFunc");
    fetch(gl.DepthMask, "glDepthMask");
    fetch(gl.BlendFunc, "glBlendFunc");
    fetch(gl.Viewport, "glViewport");
    fetch(gl.PixelStorei, "glPixelStorei");
    fetch(gl.ReadBuffer, "glReadBuffer");
    fetch(gl.ReadPixels, "glReadPixels");
    fetch(gl.Finish, "glFinish");
    fetch(gl.ClearBufferfv, "glClearBufferfv");
    fetch(gl.ClearBufferiv, "glClearBufferiv");
    fetch(gl.GenBuffers, "glGenBuffers");
    fetch(gl.DeleteBuffers, "glDeleteBuffers");
    fetch(gl.BindBuffer, "glBindBuffer");
    fetch(gl.BufferData, "glBufferData");
    fetch(gl.BufferSubData, "glBufferSubData");
    fetch(gl.GenVertexArrays, "glGenVertexArrays");
    fetch(gl.BindVertexArray, "glBindVertexArray");
    fetch(gl.EnableVertexAttribArray, "glEnableVertexAttribArray");
    fetch(gl.VertexAttribPointer, "glVertexAttribPointer");
    fetch(gl.DrawElements, "glDrawElements");
    fetch(gl.GenFramebuffers, "glGenFramebuffers");
    fetch(gl.DeleteFramebuffers, "glDeleteFramebuffers");
    fetch(gl.BindFramebuffer, "glBindFramebuffer");
    fetch(gl.FramebufferRenderbuffer, "glFramebufferRenderbuffer");
    fetch(gl.CheckFramebufferStatus, "glCheckFramebufferStatus");
    fetch(gl.GenRenderbuffers, "glGenRenderbuffers");
    fetch(gl.DeleteRenderbuffers, "glDeleteRenderbuffers");
    fetch(gl.BindRenderbuffer, "glBindRenderbuffer");
    fetch(gl.RenderbufferStorage, "glRenderbufferStorage");
    fetch(gl.CreateShader, "glCreateShader");
    fetch(gl.ShaderSource, "glShaderSource");
    fetch(gl.CompileShader, "glCompileShader");
    fetch(gl.GetShaderiv, "glGetShaderiv");
    fetch(gl.GetShaderInfoLog, "glGetShaderInfoLog");
    fetch(gl.CreateProgram, "glCreateProgram");
    fetch(gl.AttachShader, "glAttachShader");
    fetch(gl.LinkProgram, "glLinkProgram");
    fetch(gl.GetProgramiv, "glGetProgramiv");
    fetch(gl.UseProgram, "glUseProgram");
    fetch(gl.GetUniformLocation, "glGetUniformLocation");
    fetch(gl.Uniform4fv, "glUniform4fv");
    fetch(gl.GenQueries, "glGenQueries");
    fetch(gl.BeginQuery, "glBeginQuery");
    fetch(gl.EndQuery, "glEndQuery");
    fetch(gl.GetQueryObjectui64v, "glGetQueryObjectui64v");
    fetch(gl.ActiveTexture, "glActiveTexture");
    fetch(gl.BindBufferBase, "glBindBufferBase");
    fetch(gl.BindTexture, "glBindTexture");
    fetch(gl.ClearBufferData, "glClearBufferData");
    fetch(gl.ColorMask, "glColorMask");
    fetch(gl.DeleteProgram, "glDeleteProgram");
    fetch(gl.DeleteTextures, "glDeleteTextures");
    fetch(gl.DrawArrays, "glDrawArrays");
    fetch(gl.FramebufferTexture2D, "glFramebufferTexture2D");
    fetch(gl.GenTextures, "glGenTextures");
    fetch(gl.MemoryBarrier, "glMemoryBarrier");
    fetch(gl.TexStorage2D, "glTexStorage2D");
    fetch(gl.Uniform1f, "glUniform1f");
    fetch(gl.Uniform1i, "glUniform1i");
    fetch(gl.CullFace, "glCullFace");
    fetch(gl.FrontFace, "glFrontFace");
    fetch(gl.TexParameteri, "glTexParameteri");
    fetch(gl.TexSubImage2D, "glTexSubImage2D");
    return gl;
  }
};

}  // namespace rastrum::bench
