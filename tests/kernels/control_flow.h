// Control flow that depends on three constants, for vk/live_code_test.cpp: GLSL that is C++ too, without
// `precise`.

// Both ways return.
uint both_return(uint x) {
    if (A) {
        return x + 1u;
    } else {
        return x * 3u;
    }
}

// One case goes on with the next, one may leave early.
uint chosen(uint x) {
    switch (N) {
        case 0u:
            x += 5u;
            break;
        case 1u:
            x ^= 6u;
            // Falls through.
        case 2u:
            if (x > 7u) break;
            x += 100u;
            break;
        default:
            x *= 2u;
    }
    return x;
}

// Conditions that are constants decide how a loop goes on.
uint looped(uint x) {
    for (uint i = 0u; i < N; ++i) {
        if (B) {
            x += i;
            if (x > 20u) break;
        } else {
            continue;
        }
        x *= 2u;
    }
    return x;
}

// Without A, or without B, the body is never entered.
uint sometimes(uint x) {
    while (A && B) {
        x += 1u;
        if (x > 50u) return x;
    }
    return x;
}

uint at_least_once(uint x) {
    do {
        x += 3u;
        if (B) break;
        x += 10u;
    } while (N == 9u);
    return x;
}

// Control never comes back to the loop.
uint at_most_once(uint x) {
    for (;;) {
        if (A) {
            x += 7u;
            break;
        } else {
            x += 9u;
            break;
        }
    }
    return x;
}

uint short_circuit(uint x) {
    bool some = (A && x > 3u) || (B && (x & 1u) != 0u && N > 1u);
    return some ? x + 40u : x + (A ? 1u : 2u);
}

// Decorated, and gone without A.
uint decorated(uint x) {
    if (A) {
        precise float y = float(x) * 3.0f + 1.0f;
        return uint(y);
    }
    return x;
}

// Values that are known only after operations, nested.
uint computed(uint x) {
    uint bits = ((N << 2u | 1u) ^ 3u) & 13u;
    for (uint i = 0u; i < 4u; ++i) {
        if ((bits & 4u) != 0u) {
            if (!A == B) {
                if (bits - 1u >= 8u) continue;
                x += 1000u;
            }
            if (x > 3000u) break;
        }
        x += bits ^ i;
    }
    return x;
}

uint control_flow(uint which, uint x) {
    switch (which) {
        case 0u:
            return both_return(x);
        case 1u:
            return chosen(x);
        case 2u:
            return looped(x);
        case 3u:
            return sometimes(x);
        case 4u:
            return at_least_once(x);
        case 5u:
            return at_most_once(x);
        case 6u:
            return short_circuit(x);
        case 7u:
            return decorated(x);
        default:
            return computed(x);
    }
}
