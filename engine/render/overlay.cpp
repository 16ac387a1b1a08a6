#include "engine/render/overlay.hpp"

#include <algorithm>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "engine/render/overlay_panels.hpp"
#include "engine/render/renderer.hpp"

namespace fascicle {

struct Overlay::State {
  ImGuiContext* context = nullptr;
  OverlayMemory memory;
};

namespace {

constexpr float kSwatchStep = 1.4f;  // of the text's height, from a swatch to its text

void map_keys(ImGuiIO& io) {
  const auto map = [&io](ImGuiKey key, Key ours) { io.KeyMap[key] = static_cast<int>(ours); };
  map(ImGuiKey_Tab, Key::tab);
  map(ImGuiKey_LeftArrow, Key::left);
  map(ImGuiKey_RightArrow, Key::right);
  map(ImGuiKey_UpArrow, Key::up);
  map(ImGuiKey_DownArrow, Key::down);
  map(ImGuiKey_PageUp, Key::page_up);
  map(ImGuiKey_PageDown, Key::page_down);
  map(ImGuiKey_Home, Key::home);
  map(ImGuiKey_End, Key::end);
  map(ImGuiKey_Delete, Key::remove);
  map(ImGuiKey_Backspace, Key::backspace);
  map(ImGuiKey_Space, Key::space);
  map(ImGuiKey_Enter, Key::enter);
  map(ImGuiKey_Escape, Key::escape);
  map(ImGuiKey_A, Key::a);
  map(ImGuiKey_C, Key::c);
  map(ImGuiKey_V, Key::v);
  map(ImGuiKey_X, Key::x);
  map(ImGuiKey_Y, Key::y);
  map(ImGuiKey_Z, Key::z);
}

void set_style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6.0f;
  style.FrameRounding = 3.0f;
  style.WindowBorderSize = 0.0f;
  style.FramePadding = ImVec2(5.0f, 2.0f);
  style.ItemSpacing = ImVec2(6.0f, 4.0f);
  style.CellPadding = ImVec2(3.0f, 1.0f);
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.05f, 0.06f, 0.07f, 0.82f);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.16f, 0.18f, 0.21f, 0.90f);
  style.Colors[ImGuiCol_Header] = ImVec4(0.20f, 0.24f, 0.29f, 0.90f);
  style.Colors[ImGuiCol_Button] = ImVec4(0.24f, 0.32f, 0.42f, 0.95f);
  style.Colors[ImGuiCol_PlotLines] = ImVec4(0.55f, 0.78f, 0.95f, 1.0f);
}

void feed(const InputState& input, float delta_seconds, int width, int height, ImGuiIO& io) {
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = std::max(delta_seconds, 1e-5f);
  io.MousePos = ImVec2(input.mouse.x, input.mouse.y);
  for (std::size_t button = 0; button < input.buttons.size(); ++button) io.MouseDown[button] = input.buttons[button];
  io.MouseWheel += input.scroll.y;
  io.MouseWheelH += input.scroll.x;
  std::copy(input.keys.begin(), input.keys.end(), io.KeysDown);
  io.KeyShift = input.shift;
  io.KeyCtrl = input.control;
  io.KeyAlt = input.alt;
  for (const std::uint32_t code_point : input.text) io.AddInputCharacter(code_point);
}

}  // namespace

Overlay::Overlay() : state_(std::make_unique<State>()) {}

Result<std::unique_ptr<Overlay>> Overlay::create() {
  if (ImGui::GetCurrentContext() != nullptr) {
    return Diagnostic{"overlay", 0, 0, "", "there is one already", "destroy the first overlay before making another"};
  }
  std::unique_ptr<Overlay> overlay(new Overlay());
  IMGUI_CHECKVERSION();
  overlay->state_->context = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // panels stand where the code puts them
  io.LogFilename = nullptr;
  map_keys(io);
  set_style();
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) {
    return Diagnostic{"overlay", 0, 0, "", "Dear ImGui found no OpenGL functions",
                      "install libGL (Debian: libgl1), or run without the overlay"};
  }
  return overlay;
}

Overlay::~Overlay() {
  if (state_->context == nullptr) return;
  ImGui::SetCurrentContext(state_->context);
  if (ImGui::GetIO().BackendRendererUserData != nullptr) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(state_->context);
}

OverlayActions Overlay::draw(const OverlayModel& model, const InputState& input, float delta_seconds,
                             Renderer& renderer) {
  ImGui::SetCurrentContext(state_->context);
  feed(input, delta_seconds, renderer.width(), renderer.height(), ImGui::GetIO());
  state_->memory.history.push(model);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  const OverlayActions actions = lay_out_overlay(model, static_cast<float>(renderer.width()),
                                                 static_cast<float>(renderer.height()), state_->memory);
  ImGui::Render();
  renderer.bind_target();
  renderer.timer().begin_pass("overlay");
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  renderer.timer().end_pass();
  return actions;
}

void Overlay::draw_captions(std::span<const Caption> captions, float size, Renderer& renderer) {
  ImGui::SetCurrentContext(state_->context);
  feed({}, 0.0f, renderer.width(), renderer.height(), ImGui::GetIO());
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Caption& caption : captions) {
    ImVec2 at(caption.at.x, caption.at.y);
    if (caption.swatch) {
      list.AddRectFilled(at, ImVec2(at.x + size, at.y + size), caption.colour, 0.15f * size);
      at.x += kSwatchStep * size;
    }
    list.AddText(ImGui::GetFont(), size, at, caption.swatch ? 0xffffffffu : caption.colour, caption.text.data(),
                 caption.text.data() + caption.text.size());
  }
  ImGui::Render();
  renderer.bind_target();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

float Overlay::text_width(std::string_view text, float size) const {
  ImGui::SetCurrentContext(state_->context);
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsAlpha8(&pixels, &width, &height);  // makes the font where no picture has done so yet
  return fonts.Fonts[0]->CalcTextSizeA(size, 1e9f, 0.0f, text.data(), text.data() + text.size()).x;
}

bool Overlay::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Overlay::wants_keyboard() const { return ImGui::GetIO().WantTextInput; }

}  // namespace fascicle
