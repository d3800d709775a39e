"""Tones: what they consist of, and the device."""

import numpy as np
import pytest
from arkanoid.envs.play.sound import LOUDEST, RATE, Speaker, Tone, samples


@pytest.mark.parametrize("tone", Tone)
def test_a_tone_has_its_pitch_and_no_clicks(tone: Tone) -> None:
    begin, end, seconds = tone.value
    wave = samples(tone).astype(float) / 32_767
    assert len(wave) == round(seconds * RATE)
    assert 0.5 * LOUDEST < abs(wave).max() <= LOUDEST
    # It begins and ends in silence, or the loudspeaker would click.
    assert abs(wave[:3]).max() < 0.05 * LOUDEST
    assert abs(wave[-50:]).max() < 0.05 * LOUDEST
    spectrum = abs(np.fft.rfft(wave))
    loudest = np.fft.rfftfreq(len(wave), 1 / RATE)[spectrum.argmax()]
    assert min(begin, end) - 40 < loudest < max(begin, end) + 40


def test_sound_is_off_until_it_is_switched_on() -> None:
    import pygame

    speaker = Speaker()
    speaker.play([Tone.BRICK])
    assert pygame.mixer.get_init() is None
    assert speaker.switch() == "SOUND ON"
    assert pygame.mixer.get_init() == (RATE, -16, 1)
    speaker.play([Tone.BRICK, Tone.PADDLE])
    assert pygame.mixer.get_busy()
    assert speaker.switch() == "SOUND OFF"
    assert pygame.mixer.get_init() is None
    speaker.close()


def test_a_machine_without_sound_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_AUDIODRIVER", "no such driver")
    speaker = Speaker()
    assert speaker.switch() == "NO SOUND DEVICE"
    speaker.play([Tone.BRICK])
