// SPDX-License-Identifier: Apache-2.0
// A host's log: collects what the message callback receives.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "candelabra/candelabra.h"

namespace candelabra::test
{

struct Message {
    CndMessageSeverity severity;
    std::string sentence;
};

struct HostLog {
    std::vector<Message> messages;

    // Returns the device with this log as its message callback.
    CndDeviceDesc desc(CndDeviceDesc device)
    {
        device.message = [](void* user, CndMessageSeverity severity, const char* sentence) {
            static_cast<HostLog*>(user)->messages.push_back({severity, sentence});
        };
        device.messageUser = this;
        return device;
    }
    // Expects exactly one message since the last call, and that it contains `part`.
    void expect(CndMessageSeverity severity, const std::string& part)
    {
        ASSERT_EQ(messages.size(), 1u) << part;
        EXPECT_EQ(messages[0].severity, severity) << messages[0].sentence;
        EXPECT_NE(messages[0].sentence.find(part), std::string::npos) << messages[0].sentence;
        messages.clear();
    }
    void expectNone() const
    {
        for (const Message& m : messages)
            ADD_FAILURE() << m.sentence;
    }
};

} // namespace candelabra::test
