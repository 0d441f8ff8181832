!> NAME.wear.csv: the worn surfaces of pins and bores at the end of a run.
module wear_file
  use kinds, only: dp
  use error_handling, only: error_t
  use joint_places, only: spot_name
  use archard_wear, only: of_pin, of_bore
  use wear_record, only: wear_profile_t
  use growing_text, only: growing_text_t
  use number_text, only: real_text
  use result_file, only: write_text
  implicit none
  private
  public :: write_wear_file

contains

  !> Write one row for each bin of each joint: its middle, in degrees from x towards y in the frame of the body, and mean depth and
  !> volume that are worn from pin and bore there. Error: the file cannot be written (status_output).
  subroutine write_wear_file(path, worn, digits, error)
    character(len=*), intent(in) :: path
    type(wear_profile_t), intent(in) :: worn(:)
    integer, intent(in) :: digits   !! significant digits of depths and volumes
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: file
    integer :: i, j, k
    call file%append('joint,angle[deg],pin_depth[m],bore_depth[m],pin_volume[m3],bore_volume[m3]'//achar(10))
    do i = 1, size(worn)
      associate (depth => worn(i)%depth, volume => worn(i)%volume)
        do j = 1, size(depth, 1)
          call file%append(spot_name(worn(i)%place)//','//real_text((j - 0.5_dp)*360/size(depth, 1)))
          do k = of_pin, of_bore
            call file%append(','//real_text(depth(j, k), digits))
          end do
          do k = of_pin, of_bore
            call file%append(','//real_text(volume(j, k), digits))
          end do
          call file%append(achar(10))
        end do
      end associate
    end do
    call write_text(path, file%text(:file%used), error)
  end subroutine write_wear_file
end module wear_file
