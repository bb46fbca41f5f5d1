//! What a rigid contact gives while it is closed, and in a burst of impacts.

/// Impulses of one contact of the law `constraint`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rigid {
    /// While it is closed.
    pub(super) closed: Option<Closed>,
    burst: Option<Burst>,
    /// λ at the state passed last \[N\].
    pub(super) lambda: f64,
    /// Of all impacts and closures of the run [N·s].
    pub(super) impulse: f64,
}

/// A contact while it is closed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Closed {
    /// When it closed \[s\]; `None` where it did before the run began.
    pub(super) since: Option<f64>,
    /// ∫λ dt [N·s]
    pub(super) impulse: f64,
    /// Part of it that the burst has by steps already [N·s].
    pub(super) counted: f64,
    /// Largest λ \[N\].
    pub(super) force: f64,
}

/// Impacts and times of closure that follow each other closely.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Burst {
    /// When it began and ended \[s\].
    pub(super) range: [f64; 2],
    /// Of all impacts and closures [N·s].
    pub(super) impulse: f64,
    /// Number of impacts and closures.
    pub(super) parts: usize,
}

impl Rigid {
    /// Adds a step of the size h \[s\] with the force λ at its end, if it is closed: h (λ₀ + λ₁)/2.
    pub(super) fn press(&mut self, lambda: f64, h: f64) {
        let before = std::mem::replace(&mut self.lambda, lambda);
        if let Some(closed) = &mut self.closed {
            let impulse = 0.5 * h * (before + lambda);
            closed.impulse += impulse;
            self.impulse += impulse;
            closed.force = closed.force.max(lambda);
        }
    }

    /// Adds a step from `since` until `time` \[s\] whose impulse is hλ, open or closed; gives the burst that has ended before it.
    pub(super) fn push(&mut self, lambda: f64, [since, time]: [f64; 2], apart: f64) -> Option<Burst> {
        let impulse = (time - since) * lambda;
        self.impulse += impulse;
        self.lambda = lambda;
        if let Some(closed) = &mut self.closed {
            closed.impulse += impulse;
            closed.counted += impulse;
            closed.force = closed.force.max(lambda);
        }
        if lambda > 0.0 { self.add([time; 2], impulse, apart) } else { None }
    }

    /// Adds a closure until `time`, but for what it has of steps that were added by themselves, `by_step` all of it.
    pub(super) fn add_closure(
        &mut self,
        closed: &Closed,
        time: f64,
        (apart, by_step): (f64, bool),
    ) -> Option<Burst> {
        let rest = closed.impulse - closed.counted;
        if by_step && rest == 0.0 {
            return None;
        }
        self.add([closed.since.unwrap_or(f64::NEG_INFINITY), time], rest, apart)
    }

    /// Adds an impact or a closure of an impulse from `since` until `time`; gives the burst that has ended before it, `apart` \[s\] or more.
    pub(super) fn add(&mut self, [since, time]: [f64; 2], impulse: f64, apart: f64) -> Option<Burst> {
        match &mut self.burst {
            Some(burst) if since - burst.range[1] < apart => {
                (burst.range[1], burst.impulse) = (time, burst.impulse + impulse);
                burst.parts += 1;
                None
            }
            burst => burst.replace(Burst { range: [since, time], impulse, parts: 1 }),
        }
    }

    /// What later events depend on: whether it is closed, since when, impulse, the part that is counted and largest force, and of the burst beginning, end, impulse and
    /// number of parts; λ. NaN stands for what is not known.
    pub(super) fn memory(&self) -> [f64; 10] {
        let Closed { since, impulse, counted, force } = self.closed.clone().unwrap_or_default();
        let Burst { range, impulse: whole, parts } = self.burst.clone().unwrap_or_default();
        let closed = f64::from(u8::from(self.closed.is_some()));
        let since = since.unwrap_or(f64::NAN);
        [closed, since, impulse, counted, force, range[0], range[1], whole, parts as f64, self.lambda]
    }

    /// From the [memory](Rigid::memory) of a run.
    pub(super) fn recall(&mut self, memory: [f64; 10]) {
        let [closed, since, impulse, counted, force, start, end, whole, parts, lambda] = memory;
        let since = Some(since).filter(|since| !since.is_nan());
        self.closed = (closed != 0.0).then_some(Closed { since, impulse, counted, force });
        let burst = Burst { range: [start, end], impulse: whole, parts: parts as usize };
        self.burst = (parts > 0.0).then_some(burst);
        self.lambda = lambda;
    }

    /// The burst that goes on at the end of a run.
    pub(super) fn end(&mut self) -> Option<Burst> {
        self.burst.take()
    }
}
