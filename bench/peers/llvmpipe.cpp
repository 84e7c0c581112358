// A child process draws into memory with OpenGL 2 through OSMesa; the parent sends it a command
// through a pipe and waits for the answer. The clock runs in the child, from glClear to glFinish,
// so that pipes are not measured.
#include "bench/peers/llvmpipe.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// After the header that defines its types.
#include <GL/glext.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>
#include <string>

namespace delray::bench {
namespace {

enum class Command : char { render, coverage };

void write_all(int file, const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = write(file, next, bytes);
    if (done <= 0) throw std::runtime_error("llvmpipe's process is gone");
    next += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

void read_all(int file, void* data, std::size_t bytes) {
  char* next = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t done = read(file, next, bytes);
    if (done <= 0) throw std::runtime_error("llvmpipe's process is gone");
    next += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

constexpr const char* kVertexShader = R"(
#version 120
attribute vec3 position;
attribute vec3 normal;
attribute vec3 colour;
uniform mat4 to_clip;
uniform mat3 to_world;
varying vec3 lit;
void main() {
  gl_Position = to_clip * vec4(position, 1.0);
  float cosine = max(dot(normalize(to_world * normal), vec3(0.36, 0.80, 0.48)), 0.0);
  lit = colour * (0.3 + 0.7 * cosine);
})";
constexpr const char* kPixelShader = R"(
#version 120
varying vec3 lit;
void main() { gl_FragColor = vec4(lit, 1.0); })";

GLuint compile(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == 0) throw std::runtime_error("llvmpipe rejects a shader");
  return shader;
}

// View coordinates to clip coordinates; the far plane is as far as depths of 24 bits bear.
glm::mat4 to_clip(const scenes::View& view) {
  const float near = view.near, far = near * 1e5F;
  glm::mat4 look(0.0F);
  for (int k = 0; k < 3; ++k) {
    look[k][0] = view.right[k];
    look[k][1] = view.up[k];
    look[k][2] = view.forward[k];
  }
  look[3] = {-glm::dot(view.right, view.eye), -glm::dot(view.up, view.eye),
             -glm::dot(view.forward, view.eye), 1.0F};
  glm::mat4 projection(0.0F);
  projection[0][0] = view.scale / view.half_width;
  projection[1][1] = view.scale / view.half_height;
  projection[2][2] = (far + near) / (far - near);
  projection[3][2] = -2.0F * far * near / (far - near);
  projection[2][3] = 1.0F;
  return projection * look;
}

struct MeshBuffers {
  GLuint vertices = 0, indices = 0;
  GLsizei count = 0;
  bool points = false;  // of this size in pixels, drawn in the order of the vertices
  float size = 1;
};

class Picture {
 public:
  Picture(const scenes::Scene& scene, const scenes::View& view)
      : scene_(scene),
        to_clip_(to_clip(view)),
        width_(view.width),
        height_(view.height),
        pixels_(static_cast<std::size_t>(view.width) * view.height * 4) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              24,
                              OSMESA_PROFILE,
                              OSMESA_COMPAT_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              2,
                              0};
    const OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
    if (context == nullptr ||
        OSMesaMakeCurrent(context, pixels_.data(), GL_UNSIGNED_BYTE, width_, height_) == 0) {
      throw std::runtime_error("OSMesa has no context");
    }
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (renderer.find("llvmpipe") == std::string::npos) {
      throw std::runtime_error("OSMesa is not llvmpipe but " + renderer);
    }
    OSMesaPixelStore(OSMESA_Y_UP, 0);
    link();
    for (const scenes::Mesh& mesh : scene.meshes) meshes_.push_back(upload(mesh));
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glViewport(0, 0, width_, height_);
    glEnableVertexAttribArray(kPosition);
    glEnableVertexAttribArray(kNormal);
    glEnableVertexAttribArray(kColour);
  }

  double render() {
    const auto start = std::chrono::steady_clock::now();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const scenes::Instance& instance : scene_.instances) draw(instance);
    glFinish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  std::vector<std::uint8_t> coverage() const {
    std::vector<std::uint8_t> result(pixels_.size() / 4);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = pixels_[4 * i + 3] != 0;
    return result;
  }

 private:
  static constexpr GLuint kPosition = 0, kNormal = 1, kColour = 2;
  struct Vertex {
    glm::vec3 position, normal, colour;
  };

  void link() {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, kPixelShader));
    glBindAttribLocation(program, kPosition, "position");
    glBindAttribLocation(program, kNormal, "normal");
    glBindAttribLocation(program, kColour, "colour");
    glLinkProgram(program);
    glUseProgram(program);
    to_clip_location_ = glGetUniformLocation(program, "to_clip");
    to_world_location_ = glGetUniformLocation(program, "to_world");
  }

  MeshBuffers upload(const scenes::Mesh& mesh) const {
    glm::vec3 base(0.8F);
    if (mesh.material < scene_.materials.size()) {
      base = glm::vec3(scene_.materials[mesh.material].base_colour);
    }
    std::vector<Vertex> vertices(mesh.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      vertices[i] = {mesh.positions[i], mesh.normals.empty() ? glm::vec3(0, 1, 0) : mesh.normals[i],
                     mesh.colours.empty() ? base : base * glm::vec3(mesh.colours[i])};
    }
    MeshBuffers buffers;
    buffers.points = mesh.shape.kind == scenes::Shape::Kind::point;
    buffers.size = std::max(1.0F, 2 * mesh.shape.radius);
    buffers.count =
        static_cast<GLsizei>(buffers.points ? vertices.size() : 3 * mesh.triangles.size());
    glGenBuffers(1, &buffers.vertices);
    glBindBuffer(GL_ARRAY_BUFFER, buffers.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                 vertices.data(), GL_STATIC_DRAW);
    glGenBuffers(1, &buffers.indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(glm::uvec3)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    return buffers;
  }

  void draw(const scenes::Instance& instance) {
    const MeshBuffers& mesh = meshes_[instance.mesh];
    const glm::mat4 clip = to_clip_ * glm::mat4(instance.transform);
    const glm::mat3 normals = glm::transpose(glm::inverse(glm::mat3(instance.transform)));
    glUniformMatrix4fv(to_clip_location_, 1, GL_FALSE, glm::value_ptr(clip));
    glUniformMatrix3fv(to_world_location_, 1, GL_FALSE, glm::value_ptr(normals));
    glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
    const auto attribute = [](GLuint index, std::size_t offset) {
      glVertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                            reinterpret_cast<const void*>(offset));
    };
    attribute(kPosition, offsetof(Vertex, position));
    attribute(kNormal, offsetof(Vertex, normal));
    attribute(kColour, offsetof(Vertex, colour));
    if (mesh.points) {
      glPointSize(mesh.size);
      glDrawArrays(GL_POINTS, 0, mesh.count);
      return;
    }
    glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
  }

  const scenes::Scene& scene_;
  glm::mat4 to_clip_;
  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  std::vector<MeshBuffers> meshes_;
  GLint to_clip_location_ = -1, to_world_location_ = -1;
};

// Answers until the other end of the pipe is closed.
void serve(const scenes::Scene& scene, const scenes::View& view, int input, int output) {
  Picture picture(scene, view);
  Command command{};
  while (read(input, &command, 1) == 1) {
    if (command == Command::render) {
      const double seconds = picture.render();
      write_all(output, &seconds, sizeof seconds);
    } else {
      const std::vector<std::uint8_t> covered = picture.coverage();
      write_all(output, covered.data(), covered.size());
    }
  }
}

}  // namespace

Llvmpipe::Llvmpipe(const scenes::Scene& scene, const scenes::View& view, int threads)
    : pixels_(static_cast<std::size_t>(view.width) * view.height) {
  int down[2], up[2];
  if (pipe(down) != 0 || pipe(up) != 0) throw std::runtime_error("no pipe");
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("no process");
  if (child_ == 0) {
    close(down[1]);
    close(up[0]);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    int code = EXIT_SUCCESS;
    try {
      serve(scene, view, down[0], up[1]);
    } catch (const std::exception&) {
      code = EXIT_FAILURE;
    }
    _exit(code);
  }
  close(down[0]);
  close(up[1]);
  to_child_ = down[1];
  from_child_ = up[0];
}

Llvmpipe::~Llvmpipe() {
  close(to_child_);
  close(from_child_);
  waitpid(child_, nullptr, 0);
}

double Llvmpipe::render() {
  const Command command = Command::render;
  write_all(to_child_, &command, 1);
  double seconds = 0;
  read_all(from_child_, &seconds, sizeof seconds);
  return seconds;
}

std::vector<std::uint8_t> Llvmpipe::coverage() {
  const Command command = Command::coverage;
  write_all(to_child_, &command, 1);
  std::vector<std::uint8_t> result(pixels_);
  read_all(from_child_, result.data(), result.size());
  return result;
}

}  // namespace delray::bench
