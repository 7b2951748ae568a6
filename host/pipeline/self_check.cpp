#include "pipeline/self_check.h"

#include "pipeline/check_chain.h"

namespace coppice {

bool check_device(Device& device, const DeviceUse& use, const CheckFault& fault) {
  const char* wrong = check_chain_of(device.properties(), use, true).run(device, fault);
  if (!wrong) return true;
  if (use.builds || use.sorts || use.scans)
    wrong = check_chain_of(device.properties(), use, false).run(device, fault);
  if (!wrong) return false;
  throw DeviceError("device '" + device.properties().name + "' (" + device.properties().driver + ") " +
                    wrong + " in the self-check; it is not used");
}

}  // namespace coppice
