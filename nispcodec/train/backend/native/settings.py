"""The tuned numbers that the kernel is told."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

from nispcodec.train.backend.native.library import Numbers
from nispcodec.train.config import LossConfig, MuonConfig, SoapConfig, TrainConfig


@dataclass(frozen=True)
class Settings:
    """All of them, from `nispcodec.train.config`, where they are explained, and the schedule.

    loss, muon, soap
    clip             largest norm of a gradient
    momentum_share   share of all gradients so far that the momentum of hidden layers holds
    last_layer_rate  relative rate of the last layer
    ema_weight       share of the newest weights in the running mean
    """

    loss: LossConfig
    muon: MuonConfig
    soap: SoapConfig
    clip: float
    momentum_share: float
    last_layer_rate: float
    ema_weight: float

    @staticmethod
    def of(
        config: TrainConfig, momentum_share: float, last_layer_rate: float, ema_weight: float
    ) -> Settings:
        """With what the training's config says."""
        own = (momentum_share, last_layer_rate, ema_weight)
        return Settings(config.loss, config.muon, config.soap, config.loop.clip, *own)

    def numbers(self, w0: float) -> Numbers:
        """As the kernel takes them; `w0` is the network's."""
        muon, soap = self.muon, self.soap
        return Numbers(
            near=self.loss.near,
            sign_weight=self.loss.sign_weight,
            sign_softness=self.loss.sign_softness,
            w0=w0,
            last_layer_rate=self.last_layer_rate,
            ema_weight=self.ema_weight,
            clip=self.clip,
            muon_size=muon.size,
            muon_least=muon.least,
            muon_most=muon.most,
            momentum_share=self.momentum_share,
            muon_quintic=(ctypes.c_float * 3)(*muon.quintic),
            muon_rounds=muon.rounds,
            soap_beta=soap.beta,
            soap_epsilon=soap.epsilon,
            soap_refresh_every=soap.refresh_every,
        )
