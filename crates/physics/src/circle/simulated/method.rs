//! The compensation of friction on an axis by a control.

use crate::simulation::{DriveParameters, Plant, plant_list};
use crate::stiction::StictionParameters;
use frictcomp::lists::FrictionList;

/// A method of compensation with its parameters.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Method {
    /// An additive motor current from a value list.
    Current(FrictionList),
    /// An additive feed from the change of the servo lag.
    Stiction(StictionParameters),
}

impl Method {
    /// Returns the compensation of X and Y by the control of a plant itself: stiction compensation
    /// if the plant has it on any axis, otherwise the value lists that are their friction curves.
    pub fn of_plant(plant: &Plant) -> [Option<Self>; 2] {
        let drives = [&plant.x, &plant.y];
        if drives.iter().any(|drive| drive.stiction.is_some()) {
            return drives.map(|drive| drive.stiction.map(Self::Stiction));
        }
        drives.map(|drive: &DriveParameters| Some(Self::Current(plant_list(drive))))
    }

    /// Returns the value list, if there is one.
    pub fn list(&self) -> Option<&FrictionList> {
        match self {
            Self::Current(list) => Some(list),
            Self::Stiction(_) => None,
        }
    }

    /// Returns the parameters of stiction compensation, if it is that.
    pub fn stiction(&self) -> Option<&StictionParameters> {
        match self {
            Self::Stiction(parameters) => Some(parameters),
            Self::Current(_) => None,
        }
    }
}

impl From<FrictionList> for Method {
    fn from(list: FrictionList) -> Self {
        Self::Current(list)
    }
}

impl From<StictionParameters> for Method {
    fn from(parameters: StictionParameters) -> Self {
        Self::Stiction(parameters)
    }
}
