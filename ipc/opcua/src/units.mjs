// Units of measurement by their UNECE code (recommendation 20), which gives the unitId of OPC 10000-8.
import opcua from "node-opcua";

const unit = opcua.makeEUInformation;

export const kUnits = Object.freeze({
  degree: unit("DD", "\u00b0", "degree [unit of angle]"),
  degree_per_second: unit("E96", "\u00b0/s", "degree per second"),
  millimetre: unit("MMT", "mm", "millimetre"),
  millimetre_per_second: unit("C16", "mm/s", "millimetre per second"),
  degree_celsius: unit("CEL", "\u00b0C", "degree Celsius"),
});
