#include "hal/drives/odrive_dbc.h"

#include "hal/drives/odrive_wire.h"

namespace palpate::odrive {

std::string dbc_text(std::span<const int> nodes) {
  std::string text = "VERSION \"\"\n\nNS_ :\n\tSIG_VALTYPE_\n\nBS_:\n\nBU_: Controller ODrive\n\n", kinds;
  for (const int node : nodes) {
    for (const MessageShape& m : kShapes) {
      const std::string id = std::to_string(frame_id(node, m.message));
      text += "BO_ " + id + " Node" + std::to_string(node) + "_" + m.name + ": " + std::to_string(m.bytes) +
              (m.from_drive ? " ODrive\n" : " Controller\n");
      for (const Signal& s : kSignals) {
        if (s.message != m.message) continue;
        const bool real = s.number == Number::kFloat;
        text += " SG_ " + std::string(s.name) + " : " + std::to_string(s.start) + "|" + std::to_string(s.bits) + "@1" +
                (real ? "-" : "+") + " (1,0) [0|0] \"" + s.unit + "\" " + (m.from_drive ? "Controller" : "ODrive") +
                "\n";
        if (real) kinds += "SIG_VALTYPE_ " + id + " " + s.name + " : 1;\n";
      }
      text += "\n";
    }
  }
  return text + kinds;
}

}  // namespace palpate::odrive
